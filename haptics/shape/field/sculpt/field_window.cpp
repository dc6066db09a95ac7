#include "haptics/shape/field/sculpt/field_window.h"

#include "engine/core/error.h"

#include <string>

namespace touchstone {

glm::ivec3 SculptZone::low(double margin, int spare) const noexcept {
    constexpr double kBeyond = 1e9; // beyond every window, and an int
    return glm::ivec3(
        glm::clamp(glm::floor(centre - radius - margin), glm::dvec3(spare), glm::dvec3(kBeyond)));
}

glm::ivec3 SculptZone::high(const FieldWindow& window, double margin, int spare) const noexcept {
    return glm::ivec3(glm::clamp(glm::ceil(centre + radius + margin), glm::dvec3(-1.0),
                                 glm::dvec3(window.size - 1 - spare)));
}

bool ballMisses(const FieldGrid& grid, const glm::dvec3& centre, double radius) noexcept {
    const glm::dvec3 middle = grid.gridFromObject(centre);
    const glm::dvec3 nearest = glm::clamp(middle, glm::dvec3(0.0), glm::dvec3(grid.layout().cells));
    return !(glm::distance(middle, nearest) <= radius / grid.layout().voxel);
}

void placeWindow(FieldWindow& window, const FieldGrid& grid, const glm::dvec3& centre, double radius,
                 double margin) {
    const glm::dvec3 middle = grid.gridFromObject(centre), last(grid.layout().cells);
    const double reach = radius / grid.layout().voxel + margin;
    window.voxel = grid.layout().voxel;
    window.first = glm::ivec3(glm::clamp(glm::floor(middle - reach), glm::dvec3(0.0), last));
    window.size = glm::ivec3(glm::clamp(glm::ceil(middle + reach), glm::dvec3(0.0), last)) - window.first + 1;
    if (window.nodes() > kMostWindowNodes)
        throw Error("sculpting", "",
                    "the tool changes up to " + std::to_string(window.nodes()) + " nodes at once, of which " +
                        std::to_string(kMostWindowNodes) + " fit",
                    "choose a smaller radius");
}

SculptZone fillWindow(FieldWindow& window, const FieldGrid& grid, const glm::dvec3& centre, double radius,
                      double margin) {
    placeWindow(window, grid, centre, radius, margin);
    window.before.resize(window.nodes());
    grid.copyNodes(window.first, window.size, window.before);
    window.value = window.before;
    return {grid.gridFromObject(centre) - glm::dvec3(window.first), radius / grid.layout().voxel};
}

} // namespace touchstone

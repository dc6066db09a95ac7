#include "haptics/shape/field/sculpt/field_window.h"

#include "engine/core/error.h"

#include <string>

namespace touchstone {

glm::ivec3 SculptZone::low(double margin, int spare) const noexcept {
    return glm::ivec3(glm::max(glm::floor(centre - radius - margin), glm::dvec3(spare)));
}

glm::ivec3 SculptZone::high(const FieldWindow& window, double margin, int spare) const noexcept {
    return glm::ivec3(glm::min(glm::ceil(centre + radius + margin), glm::dvec3(window.size - 1 - spare)));
}

SculptZone fillWindow(FieldWindow& window, const FieldGrid& grid, const glm::dvec3& centre, double radius,
                      double margin) {
    const glm::dvec3 middle = grid.gridFromObject(centre), last(grid.layout().cells);
    const double reach = radius / grid.layout().voxel + margin;
    window.voxel = grid.layout().voxel;
    window.first = glm::ivec3(glm::clamp(glm::floor(middle - reach), glm::dvec3(0.0), last));
    window.size = glm::ivec3(glm::clamp(glm::ceil(middle + reach), glm::dvec3(0.0), last)) - window.first + 1;
    const uint64_t count = uint64_t(window.size.x) * uint64_t(window.size.y) * uint64_t(window.size.z);
    if (count > kMostWindowNodes)
        throw Error("sculpting", "",
                    "the tool changes up to " + std::to_string(count) + " nodes at once, of which " +
                        std::to_string(kMostWindowNodes) + " fit",
                    "choose a smaller radius");
    window.before.resize(count);
    grid.copyNodes(window.first, window.size, window.before);
    window.value = window.before;
    return {middle - glm::dvec3(window.first), radius / grid.layout().voxel};
}

} // namespace touchstone

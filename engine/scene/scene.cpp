#include "engine/scene/scene.h"

#include <algorithm>

namespace touchstone {

uint64_t Scene::triangleCount() const {
    uint64_t count = 0;
    for (const Instance& instance : instances)
        count += meshes[static_cast<size_t>(instance.mesh)].triangleCount();
    return count;
}

uint64_t Scene::lineCount() const {
    uint64_t count = 0;
    for (const Instance& instance : instances)
        count += meshes[static_cast<size_t>(instance.mesh)].lineCount();
    return count;
}

uint64_t Scene::pointCount() const {
    uint64_t count = 0;
    for (const Instance& instance : instances)
        count += meshes[static_cast<size_t>(instance.mesh)].pointCount();
    return count;
}

std::vector<MaterialPlacement> materialPlacements(const Scene& scene) {
    std::vector<MaterialPlacement> placements(scene.materials.size());
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        MaterialPlacement& placement = placements[static_cast<size_t>(mesh.material)];
        placement.drawn = true;
        if (mesh.triangleCount() == 0)
            continue;
        placement.placed = true;
        placement.sets[0] |= !mesh.uv0.empty();
        placement.sets[1] |= !mesh.uv1.empty();
    }
    return placements;
}

Similarity workspaceFromScene(const Scene& scene, Fit fit) {
    if (fit == Fit::None || scene.bounds.empty())
        return {};
    // Coordinates have a relative rounding error of 1e-16. A model smaller than 1e-9 of its distance from the
    // origin would, magnified, show only rounding errors, millions of kilometres apart.
    constexpr double kFinest = 1e-9;
    const glm::dvec3 extent = scene.bounds.extent(), centre = glm::abs(scene.bounds.centre());
    const double longest =
        std::max({extent.x, extent.y, extent.z, kFinest * centre.x, kFinest * centre.y, kFinest * centre.z});
    Similarity fitted;
    fitted.scale = longest > 0.0 ? kFittedExtent / longest : 1.0;
    fitted.translation = -fitted.scale * scene.bounds.centre();
    return fitted;
}

} // namespace touchstone

#include "engine/scene/scene.h"

#include <algorithm>

namespace touchstone {

uint64_t Scene::triangleCount() const {
    uint64_t count = 0;
    for (const Instance& instance : instances)
        count += meshes[static_cast<size_t>(instance.mesh)].triangleCount();
    return count;
}

Similarity workspaceFromScene(const Scene& scene, Fit fit) {
    if (fit == Fit::None || scene.bounds.empty())
        return {};
    const glm::dvec3 extent = scene.bounds.extent();
    const double longest = std::max({extent.x, extent.y, extent.z});
    Similarity fitted;
    fitted.scale = longest > 0.0 ? kFittedExtent / longest : 1.0;
    fitted.translation = -fitted.scale * scene.bounds.centre();
    return fitted;
}

} // namespace touchstone

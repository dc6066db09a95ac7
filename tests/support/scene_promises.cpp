#include "tests/support/scene_promises.h"

#include "engine/scene/mesh_vertices.h"

#include <cmath>

namespace touchstone::test {
namespace {

#define PROMISE(condition)                                                                                   \
    do {                                                                                                     \
        if (!(condition))                                                                                    \
            return #condition;                                                                               \
    } while (false)

std::optional<std::string> brokenBy(const Scene& scene, const Mesh& mesh) {
    PROMISE(mesh.material >= 0 && static_cast<size_t>(mesh.material) < scene.materials.size());
    const bool drawnOnly = !mesh.lineIndices.empty() || !mesh.pointIndices.empty();
    PROMISE(mesh.normals.size() == mesh.positions.size() || (drawnOnly && mesh.normals.empty()));
    PROMISE(!drawnOnly || mesh.indices.empty());
    if (auto fault = meshFault(mesh))
        return fault;
    for (const glm::vec3& normal : mesh.normals)
        PROMISE(std::abs(glm::length(normal) - 1.0f) < 1e-3f);
    for (const glm::vec4& tangent : mesh.tangents)
        PROMISE(std::abs(glm::length(glm::vec3(tangent)) - 1.0f) < 1e-3f && std::abs(tangent.w) == 1.0f);
    return std::nullopt;
}

bool holds(const Scene& scene, const TextureRef& texture) {
    return !texture || (static_cast<size_t>(texture.image) < scene.images.size() && texture.texCoord >= 0 &&
                        texture.texCoord <= 1);
}

} // namespace

std::optional<std::string> brokenPromise(const Scene& scene) {
    PROMISE(!scene.materials.empty());
    for (const Mesh& mesh : scene.meshes)
        if (auto broken = brokenBy(scene, mesh))
            return broken;
    for (size_t n = 0; n < scene.nodes.size(); ++n)
        PROMISE(scene.nodes[n].parent < static_cast<int>(n));
    for (const Instance& instance : scene.instances)
        PROMISE(static_cast<size_t>(instance.mesh) < scene.meshes.size() &&
                static_cast<size_t>(instance.node) < scene.nodes.size());
    for (const Material& material : scene.materials) {
        for (const TextureRef* texture : material.lookTextures())
            PROMISE(holds(scene, *texture));
        if (material.haptic.height.value)
            PROMISE(holds(scene, material.haptic.height.value->texture));
    }
    for (const Image& image : scene.images)
        PROMISE(!image.decoded || !image.pixels.bytes.empty());
    for (const Animation& animation : scene.animations)
        for (const AnimationChannel& channel : animation.channels) {
            PROMISE(static_cast<size_t>(channel.node) < scene.nodes.size() && !channel.times.empty());
            const size_t keys =
                channel.times.size() * (channel.interpolation == Interpolation::CubicSpline ? 3 : 1);
            const bool weights = channel.path == AnimatedPath::Weights;
            PROMISE(channel.values.size() == (weights ? 0 : keys));
            PROMISE(channel.weights.size() == (weights ? keys * channel.targets : 0));
        }
    PROMISE(scene.bounds.empty() || std::isfinite(scene.bounds.diagonal()));
    return std::nullopt;
}

#undef PROMISE

} // namespace touchstone::test

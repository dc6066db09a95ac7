#include "workbench/model/shown_soft_bodies.h"

#include <array>
#include <span>
#include <vector>

namespace touchstone {

void ShownSoftBodies::show(SoftStates& soft, const Scene& scene, const HapticScene& haptic,
                           SceneRenderer& renderer) {
    if (!renderer.hasScene())
        return;
    const bool moved = soft.publication().update();
    if (!moved && sceneNumber_ == renderer.sceneNumber())
        return;
    sceneNumber_ = renderer.sceneNumber();
    std::span<const glm::vec3> places = soft.publication().value();
    DrawnVertices drawn;
    for (const SoftStates::Shown& shown : soft.shown()) {
        const HapticObject& object = *haptic.objects[shown.object];
        const int m = scene.instances[static_cast<size_t>(object.instance)].mesh;
        const Mesh& mesh = scene.meshes[static_cast<size_t>(m)];
        const glm::dmat4 meshFromObject = glm::inverse(object.objectFromMesh);
        drawn = {mesh.positions, std::vector<glm::vec3>(mesh.normals.size(), glm::vec3(0.0f)), mesh.tangents};
        // Triangles have their corners in either order: normals face as those of the mesh at rest do.
        std::vector<glm::vec3> sums(shown.vertices, glm::vec3(0.0f));
        std::vector<glm::vec3> inMesh;
        for (const glm::vec3& place : places.first(shown.vertices))
            inMesh.emplace_back(glm::dvec3(meshFromObject * glm::dvec4(glm::dvec3(place), 1.0)));
        const bool mirrors = glm::determinant(object.objectFromMesh) < 0.0;
        for (size_t i = 0; i + 2 < object.indices.size(); i += 3) {
            std::array<glm::vec3, 3> at;
            for (size_t k = 0; k < 3; ++k) {
                at[k] = inMesh[object.indices[i + k]];
                drawn.positions[object.sourceIndices[i + k]] = at[k];
            }
            const glm::vec3 twice = glm::cross(at[1] - at[0], at[2] - at[0]) * (mirrors ? -1.0f : 1.0f);
            for (size_t k = 0; k < 3; ++k)
                sums[object.indices[i + k]] += twice;
        }
        for (size_t i = 0; i < object.indices.size() && !drawn.normals.empty(); ++i)
            if (const glm::vec3& sum = sums[object.indices[i]]; glm::length(sum) > 0.0f)
                drawn.normals[object.sourceIndices[i]] = glm::normalize(sum);
        renderer.setMeshVertices(m, drawn);
        places = places.subspan(shown.vertices);
    }
}

} // namespace touchstone

#include "workbench/model/dented_meshes.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// Of press_dents.cpp: where the surface turns away from the dent's normal.
constexpr double kTurned = 0.2;

bool drawsDents(const Scene& scene, int mesh) {
    if (scene.meshes[static_cast<size_t>(mesh)].deformation != nullptr)
        return false;
    return std::ranges::count(scene.instances, mesh, &Instance::mesh) == 1;
}

/// A dent in the frame of its object.
struct Hollow {
    glm::dvec3 centre{0.0}, normal{0.0};
    double depth = 0.0, radius = 0.0; // object units
};

std::vector<Hollow> hollowsOf(const HapticScene& haptic, size_t object, const LocalDeformation& law,
                              std::span<const Dents> hands) {
    const double scale = haptic.restMotions[object].workspaceFromObject.scale;
    std::vector<Hollow> hollows;
    for (const Dents& dents : hands)
        for (size_t i = 0; i < Dents::kMax; ++i)
            if (dents.depth[i] > 0.0 && dents.object[i] == static_cast<int>(object))
                hollows.push_back({dents.centre[i], dents.normal[i], dents.depth[i] / scale,
                                   law.radius * haptic.workspaceFromScene.scale / scale});
    return hollows;
}

} // namespace

bool dentedVertices(const Scene& scene, const HapticScene& haptic, size_t object,
                    std::span<const Dents> hands, DrawnVertices& drawn) {
    const HapticObject& felt = *haptic.objects[object];
    const LocalDeformation& law = haptic.materials[static_cast<size_t>(felt.material)].deformation;
    const std::vector<Hollow> hollows = hollowsOf(haptic, object, law, hands);
    const Mesh& mesh =
        scene.meshes[static_cast<size_t>(scene.instances[static_cast<size_t>(felt.instance)].mesh)];
    const glm::dmat3 linear(felt.objectFromMesh);
    if (hollows.empty() || !(std::abs(glm::determinant(linear)) > 0.0))
        return false;
    const glm::dmat4 meshFromObject = glm::inverse(felt.objectFromMesh);
    const glm::dmat3 normalFromMesh = glm::transpose(glm::inverse(linear)),
                     meshFromNormal = glm::transpose(linear);
    drawn.positions = mesh.positions;
    drawn.normals = mesh.normals;
    drawn.tangents = mesh.tangents;
    bool moved = false;
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::dvec3 at(felt.objectFromMesh * glm::dvec4(glm::dvec3(mesh.positions[v]), 1.0));
        glm::dvec3 place = at, normal(0.0);
        if (!mesh.normals.empty())
            normal = glm::normalize(normalFromMesh * glm::dvec3(mesh.normals[v]));
        const glm::dvec3 rest = normal;
        for (const Hollow& hollow : hollows) {
            const glm::dvec3 away = at - hollow.centre;
            const double distance = glm::length(away), s = distance / hollow.radius;
            const double facing =
                mesh.normals.empty() ? 1.0 : std::clamp(glm::dot(hollow.normal, rest) / kTurned, 0.0, 1.0);
            const double depth = hollow.depth * facing;
            if (!(s < 1.0) || depth == 0.0)
                continue;
            place -= depth * law.shape(s) * hollow.normal;
            // Of x -> x - n D the cofactor matrix turns m into (1 - n . grad D) m + (n . m) grad D.
            if (distance > 0.0) {
                const glm::dvec3 slope = (depth * law.slope(s) / (hollow.radius * distance)) * away;
                normal += glm::dot(hollow.normal, normal) * slope - glm::dot(hollow.normal, slope) * normal;
            }
        }
        if (place == at)
            continue;
        moved = true;
        drawn.positions[v] = glm::vec3(glm::dvec3(meshFromObject * glm::dvec4(place, 1.0)));
        const glm::dvec3 turned = meshFromNormal * normal;
        if (!mesh.normals.empty() && glm::length(turned) > 0.0)
            drawn.normals[v] = glm::vec3(glm::normalize(turned));
    }
    return moved;
}

void DentedMeshes::show(const HandDents& dents, const Scene& scene, const HapticScene& haptic,
                        SceneRenderer& renderer) {
    if ((!haptic.plan.deformation && shown_.empty()) || !renderer.hasScene())
        return;
    std::vector<int> dented;
    for (size_t k = 0; haptic.plan.deformation && k < haptic.objects.size(); ++k) {
        const int instance = haptic.objects[k]->instance;
        if (instance < 0)
            continue;
        const int mesh = scene.instances[static_cast<size_t>(instance)].mesh;
        if (!drawsDents(scene, mesh) || !dentedVertices(scene, haptic, k, dents, drawn_))
            continue;
        renderer.setMeshVertices(mesh, drawn_);
        dented.push_back(mesh);
    }
    for (const int mesh : shown_)
        if (static_cast<size_t>(mesh) < scene.meshes.size() && // of the scene shown before
            std::ranges::find(dented, mesh) == dented.end()) {
            const Mesh& rest = scene.meshes[static_cast<size_t>(mesh)];
            drawn_ = {rest.positions, rest.normals, rest.tangents};
            renderer.setMeshVertices(mesh, drawn_);
        }
    shown_ = std::move(dented);
}

} // namespace touchstone

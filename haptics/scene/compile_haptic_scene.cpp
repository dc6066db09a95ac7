#include "haptics/haptic_scene.h"

#include <string>

namespace touchstone {

namespace {

std::string percent(double share) {
    return std::to_string(static_cast<int>(share * 100.0 + 0.5)) + " %";
}

/// What the objects with a material have to say about its effects.
struct UsedBy {
    int objects = 0;
    bool smooth = false, vertexHeights = false;
    uint64_t reliefBytes = 0; ///< heights and gradients at the vertices
};

/// Decides for one material which effects it calls for, with the reason that `inspect` prints.
void planMaterial(int index, const Material& material, const HapticMaterialData& data, const UsedBy& by,
                  EffectPlan& plan) {
    const bool smooth = by.smooth;
    const auto add = [&](Effect effect, bool on, std::string reason, uint64_t memory) {
        if (by.objects == 0) {
            on = false;
            reason = "no touchable triangle has this material";
        }
        plan.effects.push_back({effect, index, on, std::move(reason), memory});
    };
    add(Effect::ForceShading, data.shading != ShadingMode::Off && smooth,
        data.shading == ShadingMode::Off ? "the material turns it off"
        : smooth ? "vertex normals leave the face normals: the surface is meant to be smooth, " +
                       std::string(data.shading == ShadingMode::TwoPass     ? "two-pass"
                                   : data.shading == ShadingMode::Projected ? "projected"
                                                                            : "direction")
                 : "vertex normals equal the face normals: facets are meant",
        0);
    add(Effect::NormalMap, !data.normal.empty(),
        !data.normal.empty()     ? "normal map, felt share " + percent(data.normalScale)
        : material.normalTexture ? "the normal map is not felt or could not be read"
                                 : "no normal map",
        data.normal.memoryBytes());
    add(Effect::HeightMap, !data.height.empty() || by.vertexHeights,
        !data.height.empty() ? "height map, " + std::to_string(data.heightScale * 1e3) + " mm black to white"
        : by.vertexHeights   ? "vertex heights (_HEIGHT)"
                             : "no height map",
        data.height.memoryBytes() + by.reliefBytes);
    add(Effect::Friction, data.staticFriction > 0.0,
        data.staticFriction > 0.0 ? "static " + std::to_string(data.staticFriction) + ", dynamic " +
                                        std::to_string(data.dynamicFriction)
                                  : "no coefficient stated or derived",
        data.friction.map.memoryBytes());
    add(Effect::ViscousFriction, data.viscousFriction > 0.0,
        data.viscousFriction > 0.0 ? "stated" : "none stated", 0);
    add(Effect::Damping, data.damping > 0.0 || !data.dampingMap.map.empty(),
        data.damping > 0.0 ? "stated" : "none stated", data.dampingMap.map.memoryBytes());
    add(Effect::StiffnessMap, !data.stiffnessMap.map.empty(),
        data.stiffnessMap.map.empty() ? "no stiffness map" : "stiffness map",
        data.stiffnessMap.map.memoryBytes());
}

} // namespace

const char* effectName(Effect effect) {
    switch (effect) {
    case Effect::ForceShading:
        return "force shading";
    case Effect::NormalMap:
        return "normal map";
    case Effect::HeightMap:
        return "height map";
    case Effect::Friction:
        return "friction";
    case Effect::ViscousFriction:
        return "viscous friction";
    case Effect::Damping:
        return "damping";
    case Effect::StiffnessMap:
        return "stiffness map";
    }
    return "";
}

void settlePlan(HapticScene& scene) {
    EffectPlan& plan = scene.plan;
    plan.plainFeel = true;
    plan.anyShading = plan.twoPassShading = plan.oneFacetShading = false;
    for (HapticMaterialData& m : scene.materials)
        m.plain = !m.textured() && m.normal.empty() && m.height.empty() && m.friction.map.empty() &&
                  m.stiffnessMap.map.empty() && m.dampingMap.map.empty() && !(m.staticFriction > 0.0) &&
                  !(m.viscousFriction > 0.0);
    for (const auto& object : scene.objects) {
        if (!object->stiffness.empty() || !object->damping.empty() || !object->friction.empty() ||
            !object->heights.empty())
            scene.materials[static_cast<size_t>(object->material)].plain = false;
        plan.plainFeel &= scene.materials[static_cast<size_t>(object->material)].plain;
        const ShadingMode mode = scene.materials[static_cast<size_t>(object->material)].shading;
        const bool shaded = object->anySmooth && mode != ShadingMode::Off;
        plan.anyShading |= shaded;
        plan.twoPassShading |= shaded && mode == ShadingMode::TwoPass;
        plan.oneFacetShading |= shaded && mode != ShadingMode::TwoPass;
    }
}

std::shared_ptr<HapticScene> copyOf(const HapticScene& scene) {
    auto copy = std::make_shared<HapticScene>();
    copy->objects = scene.objects;
    copy->restMotions = scene.restMotions;
    copy->restSpheres = scene.restSpheres;
    copy->boundingRadii = scene.boundingRadii;
    copy->materials = scene.materials;
    copy->plan = scene.plan;
    copy->workspaceFromScene = scene.workspaceFromScene;
    copy->limits = scene.limits;
    return copy;
}

void removeEffect(HapticMaterialData& material, Effect effect) {
    switch (effect) {
    case Effect::ForceShading:
        material.shading = ShadingMode::Off;
        return;
    case Effect::NormalMap:
        material.normal = {};
        return;
    case Effect::HeightMap:
        material.height = {};
        return;
    case Effect::Friction:
        material.staticFriction = material.dynamicFriction = 0.0;
        material.friction = {};
        return;
    case Effect::ViscousFriction:
        material.viscousFriction = 0.0;
        return;
    case Effect::Damping:
        material.damping = 0.0;
        material.dampingMap = {};
        return;
    case Effect::StiffnessMap:
        material.stiffnessMap = {};
        return;
    }
}

void HapticScene::buildNeighbourhoods() const {
    const std::lock_guard lock(building_);
    if (built_ != nullptr)
        return;
    std::vector<MeshAdjacency> all;
    all.reserve(objects.size());
    for (const auto& object : objects)
        all.emplace_back(object->vertices, object->indices);
    built_ = std::make_unique<const std::vector<MeshAdjacency>>(std::move(all));
    neighbourhoods_.store(built_.get(), std::memory_order_release);
}

std::shared_ptr<const HapticScene>
compileHapticScene(const Scene& scene, const Similarity& workspaceFromScene, const DeviceLimits& limits) {
    auto haptic = std::make_shared<HapticScene>();
    haptic->workspaceFromScene = workspaceFromScene;
    haptic->limits = limits;
    std::vector<UsedBy> by(scene.materials.size());
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(scene.instances[i].mesh)];
        if (mesh.triangleCount() == 0)
            continue;
        auto object = buildHapticObject(scene, static_cast<int>(i), workspaceFromScene);
        UsedBy& material = by[static_cast<size_t>(object->material)];
        ++material.objects;
        material.smooth |= object->anySmooth;
        material.vertexHeights |= !object->heights.empty();
        material.reliefBytes += object->reliefBytes();
        haptic->restMotions.push_back({object->workspaceFromObject, object->workspaceFromObject});
        haptic->restSpheres.push_back(boundingSphere(*object, object->workspaceFromObject));
        haptic->boundingRadii.push_back(object->boundingRadius);
        haptic->objects.push_back(std::move(object));
    }
    for (size_t m = 0; m < scene.materials.size(); ++m) {
        const int index = static_cast<int>(m);
        haptic->materials.push_back(by[m].objects > 0 ? buildHapticMaterial(scene, index, haptic->warnings)
                                                      : HapticMaterialData{});
        planMaterial(index, scene.materials[m], haptic->materials.back(), by[m], haptic->plan);
    }
    settlePlan(*haptic);
    return haptic;
}

} // namespace touchstone

#include "haptics/scene/plan_effects.h"

#include "haptics/program/felt_program.h"
#include "haptics/settings/bezier_shading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <string>
#include <utility>

namespace touchstone {

namespace {

std::string number(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%g", value);
    return text.data();
}

bool anyPositive(const std::vector<float>& values) {
    return std::any_of(values.begin(), values.end(), [](float value) { return value > 0.0f; });
}

/// An effect's verdict: what it reads, as "a, b", or why it is off.
struct Verdict {
    bool on = false;
    std::string reason;
};

/// `sources` that are not empty, joined; else `otherwise`.
Verdict fromSources(std::initializer_list<std::string> sources, std::string otherwise) {
    Verdict verdict;
    for (const std::string& source : sources)
        if (!source.empty())
            verdict.reason += (verdict.reason.empty() ? "" : ", ") + source;
    verdict.on = !verdict.reason.empty();
    if (!verdict.on)
        verdict.reason = std::move(otherwise);
    return verdict;
}

std::string factorText(const char* what, const HapticFactor& factor) {
    return factor.map.empty()
               ? ""
               : std::string(what) + " map, factor " + number(factor.min) + " to " + number(factor.max);
}

Verdict shading(const HapticMaterialData& data, const MaterialUse& use) {
    if (data.shading == ShadingMode::Off)
        return {false, "the material turns it off"};
    if (!use.smooth)
        return {false, "vertex normals equal the face normals: facets are meant"};
    const char* kind = data.shading == ShadingMode::TwoPass     ? "two-pass"
                       : data.shading == ShadingMode::Projected ? "projected"
                       : data.shading == kBezierShading         ? "two-pass with tactile shading's patch"
                                                                : "direction";
    return {true, (use.field ? "the gradient of the distance field, "
                             : "vertex normals leave the face normals: the surface is meant to be smooth, ") +
                      std::string(kind)};
}

Verdict normalMap(const Material& material, const HapticMaterialData& data) {
    if (!data.normal.empty())
        return {true, "normal map, felt share " + number(100.0 * data.normalScale) + " %"};
    return {false, !material.normalTexture   ? "no normal map"
                   : data.normalScale == 0.0 ? "the normal map's felt share is 0"
                                             : "the normal map has no coordinates or could not be read"};
}

Verdict heightMap(const Material& material, const HapticMaterialData& data, const MaterialUse& use) {
    const auto& stated = material.haptic.height.value;
    return fromSources(
        {data.height.empty() ? "" : "height map, " + number(data.heightScale * 1e3) + " mm black to white",
         use.heights ? "vertex heights (_HEIGHT)" : ""},
        !stated                 ? "no height map"
        : stated->scale == 0.0f ? "the height map's scale is 0"
                                : "the height map has no coordinates or could not be read");
}

/// A map alone has no effect until a session sets the coefficient.
Verdict friction(const HapticMaterialData& data, const MaterialUse& use) {
    if (data.staticFriction > 0.0 || use.friction)
        return fromSources(
            {data.staticFriction > 0.0
                 ? "static " + number(data.staticFriction) + ", dynamic " + number(data.dynamicFriction)
                 : "",
             use.friction ? "vertex friction (_FRICTION)" : "", factorText("friction", data.friction)},
            "");
    return {false, data.friction.map.empty() ? "no coefficient stated or derived"
                                             : "a friction map, but no coefficient for it to multiply"};
}

Verdict damping(const HapticMaterialData& data, const MaterialUse& use) {
    if (data.damping > 0.0 || use.damping)
        return fromSources({data.damping > 0.0 ? number(data.damping) + " N s/m" : "",
                            use.damping ? "vertex damping (_DAMPING)" : "",
                            factorText("damping", data.dampingMap)},
                           "");
    return {false,
            data.dampingMap.map.empty() ? "none stated" : "a damping map, but no damping for it to multiply"};
}

Verdict programVerdict(const Material& material, const HapticMaterialData& data) {
    if (data.program != nullptr)
        return {true, data.program->name + ", " + std::to_string(data.program->code.instructions.size()) +
                          " instructions"};
    return {false, material.says.ours.shader.is_null() ? "none stated" : "the program has a flaw"};
}

Verdict deformationVerdict(const HapticMaterialData& data) {
    const LocalDeformation& dent = data.deformation;
    if (!dent.on())
        return {false, "none stated"};
    return {true,
            "dents of " + number(1e3 * dent.radius) + " mm, " +
                (std::isnan(dent.stiffness) ? "as stiff as the contact" : number(dent.stiffness) + " N/m") +
                (dent.time > 0.0 ? ", " + number(dent.time) + " s" : "")};
}

} // namespace

void MaterialUse::add(const HapticObject& object) {
    const AttributeBytes more = object.attributeBytes();
    smooth |= object.anySmooth;
    field |= object.shape != nullptr;
    heights |= !object.heights.empty();
    stiffness |= !object.stiffness.empty();
    damping |= anyPositive(object.damping);
    friction |= anyPositive(object.friction);
    bytes.normals += more.normals;
    bytes.tangents += more.tangents;
    bytes.uv[0] += more.uv[0];
    bytes.uv[1] += more.uv[1];
    bytes.bump += more.bump;
    bytes.stiffness += more.stiffness;
    bytes.damping += more.damping;
    bytes.friction += more.friction;
}

void planMaterial(int index, const Material& material, const HapticMaterialData& data, const MaterialUse& use,
                  EffectPlan& plan) {
    const auto add = [&](Effect effect, Verdict verdict, uint64_t memory) {
        const bool needsTriangles =
            effect == Effect::NormalMap || effect == Effect::HeightMap || effect == Effect::VaryingStiffness;
        if (!use.placed)
            verdict = {false, "no touchable triangle has this material"};
        else if (use.field && needsTriangles && verdict.on)
            verdict = {false, "a distance field has no coordinates and no vertices"};
        plan.effects.push_back({effect, index, verdict.on, std::move(verdict.reason), memory});
    };
    // Coordinates that several maps read count once, with the first of them.
    std::array<uint64_t, 2> coordinates{use.bytes.uv[0], use.bytes.uv[1]};
    const auto mapBytes = [&](const HapticMap& map) {
        return map.memoryBytes() +
               (map.empty() ? 0
                            : std::exchange(coordinates[static_cast<size_t>(map.layout().texCoord & 1)], 0));
    };
    add(Effect::ForceShading, shading(data, use), use.bytes.normals);
    add(Effect::NormalMap, normalMap(material, data), mapBytes(data.normal) + use.bytes.tangents);
    add(Effect::HeightMap, heightMap(material, data, use), mapBytes(data.height) + use.bytes.bump);
    add(Effect::Friction, friction(data, use), mapBytes(data.friction.map) + use.bytes.friction);
    add(Effect::ViscousFriction,
        data.viscousFriction > 0.0 ? Verdict{true, number(data.viscousFriction) + " N s/m"}
                                   : Verdict{false, "none stated"},
        0);
    add(Effect::Damping, damping(data, use), mapBytes(data.dampingMap.map) + use.bytes.damping);
    add(Effect::VaryingStiffness,
        fromSources({use.stiffness ? "vertex stiffness (_STIFFNESS)" : "",
                     factorText("stiffness", data.stiffnessMap)},
                    "one stiffness all over"),
        mapBytes(data.stiffnessMap.map) + use.bytes.stiffness);
    uint64_t code = 0;
    if (data.program != nullptr)
        code = data.program->memoryBytes() +
               (data.program->usesCoordinates ? std::exchange(coordinates[0], 0) : 0);
    add(Effect::Program, programVerdict(material, data), code);
    add(Effect::LocalDeformation, deformationVerdict(data), 0);
}

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
    case Effect::VaryingStiffness:
        return "varying stiffness";
    case Effect::Program:
        return "haptic program";
    case Effect::LocalDeformation:
        return "local deformation";
    }
    return "";
}

/// A map or an attribute without a coefficient above zero has no effect and does not count: see feelsPlain.
void settlePlan(HapticScene& scene) {
    EffectPlan& plan = scene.plan;
    plan.plainSample = true;
    plan.dampingMap = plan.oneSided = plan.programs = plan.deformation = false;
    plan.anyShading = plan.twoPassShading = plan.oneFacetShading = false;
    for (HapticMaterialData& m : scene.materials)
        m.plain = m.normal.empty() && m.height.empty() && m.stiffnessMap.map.empty() &&
                  (m.dampingMap.map.empty() || !(m.damping > 0.0)) && !(m.staticFriction > 0.0) &&
                  !(m.viscousFriction > 0.0) && m.program == nullptr && !m.deformation.on();
    for (const auto& object : scene.objects) {
        HapticMaterialData& m = scene.materials[static_cast<size_t>(object->material)];
        // Zero vertex damping overrides the material's damping.
        const bool damped = anyPositive(object->damping) || (!object->damping.empty() && m.damping > 0.0);
        if (!object->stiffness.empty() || !object->heights.empty() || damped || anyPositive(object->friction))
            m.plain = false;
        plan.dampingMap |= !m.dampingMap.map.empty();
        plan.oneSided |= object->oneSided;
        plan.programs |= m.program != nullptr;
        plan.deformation |= m.deformation.on();
        const ShadingMode mode = m.shading;
        const bool shaded = object->anySmooth && mode != ShadingMode::Off;
        plan.anyShading |= shaded;
        plan.twoPassShading |= shaded && (mode == ShadingMode::TwoPass || mode == kBezierShading);
        plan.oneFacetShading |= shaded && mode != ShadingMode::TwoPass && mode != kBezierShading;
    }
    for (const auto& object : scene.objects)
        plan.plainSample &= scene.materials[static_cast<size_t>(object->material)].plain;
}

namespace {

void takeOff(Effect effect, HapticMaterialData& material) {
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
    case Effect::VaryingStiffness:
        material.stiffnessMap = {};
        return;
    case Effect::Program:
        material.program = nullptr;
        return;
    case Effect::LocalDeformation:
        material.deformation = {};
        return;
    }
}

/// The vertex attribute that the effect reads, if it reads one.
std::vector<float>* attributeOf(Effect effect, HapticObject& object) {
    switch (effect) {
    case Effect::HeightMap:
        return &object.heights;
    case Effect::Friction:
        return &object.friction;
    case Effect::Damping:
        return &object.damping;
    case Effect::VaryingStiffness:
        return &object.stiffness;
    case Effect::ForceShading:
    case Effect::NormalMap:
    case Effect::ViscousFriction:
    case Effect::Program:
    case Effect::LocalDeformation:
        break;
    }
    return nullptr;
}

} // namespace

void removeEffect(HapticScene& scene, int material, Effect effect) {
    takeOff(effect, scene.materials[static_cast<size_t>(material)]);
    if (effect == Effect::Program && !scene.texels.empty()) {
        for (size_t k = 0; k < scene.texels.size(); ++k)
            if (scene.objects[k]->material == material)
                scene.texels[k] = nullptr;
        if (std::ranges::all_of(scene.texels, [](const auto& texels) { return texels == nullptr; }))
            scene.texels.clear();
    }
    for (auto& object : scene.objects) {
        if (object->material != material)
            continue;
        HapticObject copy = *object; // without the search tree of rays
        std::vector<float>* attribute = attributeOf(effect, copy);
        if (attribute == nullptr || attribute->empty())
            continue;
        attribute->clear();
        object = std::make_shared<const HapticObject>(std::move(copy));
        if (scene.hasRays())
            object->rays.build(*object);
    }
    settlePlan(scene);
}

} // namespace touchstone

#include "haptics/texture/haptic_material.h"

#include "haptics/settings/bezier_shading.h"

#include <algorithm>
#include <array>
#include <string>

namespace touchstone {

namespace {

/// Builds the maps of one material.
struct MapMaker {
    const Scene& scene;
    const CoordinateSets& sets;
    std::vector<Warning>& warnings;

    /// Empty, with a warning, where the image could not be read or no mesh has the coordinates. `known`: the
    /// same map, if it exists already.
    [[nodiscard]] HapticMap map(const TextureRef& reference, int channels, const std::string& place,
                                const HapticMap* known) {
        if (!reference)
            return {};
        if (known != nullptr && !known->empty())
            return *known;
        if (!sets[static_cast<size_t>(reference.texCoord & 1)]) {
            warnings.push_back({place, "not felt: no mesh with this material has texture coordinates " +
                                           std::to_string(reference.texCoord)});
            return {};
        }
        const Image& image = scene.images[static_cast<size_t>(reference.image)];
        if (image.pixels.bytes.empty()) {
            if (!image.problem.empty())
                warnings.push_back({place, "not felt: " + image.problem});
            return {};
        }
        return {image.pixels, reference, channels};
    }

    [[nodiscard]] HapticFactor factor(const HapticMaterial::Field<FactorMap>& field, const std::string& place,
                                      const HapticMaterial::Field<FactorMap>* fieldBefore,
                                      const HapticFactor* before) {
        HapticFactor factor;
        if (!field.value)
            return factor;
        const bool same = fieldBefore != nullptr && fieldBefore->value &&
                          fieldBefore->value->texture == field.value->texture;
        factor.map = map(field.value->texture, 1, place, same ? &before->map : nullptr);
        factor.min = static_cast<double>(field.value->min);
        factor.max = static_cast<double>(field.value->max);
        return factor;
    }
};

double numberOr(const HapticMaterial::Field<float>& field, double otherwise) {
    return field.value ? static_cast<double>(*field.value) : otherwise;
}

ShadingMode shadingOf(ShadingChoice choice) {
    switch (choice) {
    case ShadingChoice::Off:
        return ShadingMode::Off;
    case ShadingChoice::Projected:
        return ShadingMode::Projected;
    case ShadingChoice::Direction:
        return ShadingMode::Direction;
    case ShadingChoice::Auto:
    case ShadingChoice::TwoPass:
        break;
    case ShadingChoice::Bezier:
        return kBezierShading;
    }
    return ShadingMode::TwoPass;
}

/// Stated, or that of a Kelvin-Voigt material: stiffness times retardation time. NaN: neither.
double dampingOf(const HapticMaterial& haptic, const std::string& place, std::vector<Warning>& warnings) {
    const double time = numberOr(haptic.retardationTime, 0.0);
    if (haptic.damping.value || !(time > 0.0))
        return numberOr(haptic.damping, NAN);
    if (haptic.stiffness.value)
        return static_cast<double>(*haptic.stiffness.value) * time;
    warnings.push_back({place, "a retardation time has no effect without a stiffness; felt without damping"});
    return NAN;
}

LocalDeformation deformationOf(const HapticMaterial& haptic) {
    LocalDeformation made;
    made.radius = numberOr(haptic.deformationRadius, made.radius);
    made.stiffness = numberOr(haptic.deformationStiffness, made.stiffness);
    made.linear = numberOr(haptic.deformationLinear, made.linear);
    made.quadratic = numberOr(haptic.deformationQuadratic, made.quadratic);
    made.time = numberOr(haptic.relaxationTime, made.time);
    return made;
}

} // namespace

HapticMaterialData buildHapticMaterial(const Scene& scene, const Material& material, size_t index,
                                       const CoordinateSets& sets, std::vector<Warning>& warnings,
                                       const SettledMaterial& before) {
    const HapticMaterial& haptic = material.haptic;
    const std::string place = "materials[" + std::to_string(index) + "]";
    HapticMaterialData data;
    data.stiffness = numberOr(haptic.stiffness, NAN);
    data.damping = dampingOf(haptic, place, warnings);
    data.staticFriction = numberOr(haptic.staticFriction, 0.0);
    data.dynamicFriction = numberOr(haptic.dynamicFriction, data.staticFriction);
    data.viscousFriction = numberOr(haptic.viscousFriction, 0.0);
    if (data.dynamicFriction > data.staticFriction) {
        if (haptic.staticFriction.value)
            warnings.push_back({place, "dynamic friction above static friction; clamped to it"});
        else
            data.staticFriction = data.dynamicFriction;
        data.dynamicFriction = data.staticFriction;
    }
    const double influence = numberOr(haptic.normalTextureInfluence, 1.0);
    MapMaker maker{scene, sets, warnings};
    data.normalScale = static_cast<double>(material.normalScale) * influence;
    if (data.normalScale != 0.0)
        data.normal = maker.map(material.normalTexture, 3, place + ".normalTexture",
                                before.data != nullptr ? &before.data->normal : nullptr);
    if (haptic.height.value && haptic.height.value->scale != 0.0f) {
        const auto* height = before.data != nullptr ? &before.material->haptic.height.value : nullptr;
        const bool same = height != nullptr && *height && (*height)->texture == haptic.height.value->texture;
        data.height = maker.map(haptic.height.value->texture, 1, place + ".heightTexture",
                                same ? &before.data->height : nullptr);
        data.heightScale = static_cast<double>(haptic.height.value->scale);
        data.heightMid = static_cast<double>(haptic.height.value->midLevel);
    }
    const auto factor = [&](auto field, auto made, const char* name) {
        const HapticMaterial* was = before.data != nullptr ? &before.material->haptic : nullptr;
        data.*made =
            maker.factor(haptic.*field, place + "." + name, was != nullptr ? &(was->*field) : nullptr,
                         was != nullptr ? &(before.data->*made) : nullptr);
    };
    factor(&HapticMaterial::friction, &HapticMaterialData::friction, "frictionTexture");
    factor(&HapticMaterial::stiffnessMap, &HapticMaterialData::stiffnessMap, "stiffnessTexture");
    factor(&HapticMaterial::dampingMap, &HapticMaterialData::dampingMap, "dampingTexture");
    const std::array maps{&data.normal, &data.height, &data.friction.map, &data.stiffnessMap.map,
                          &data.dampingMap.map};
    for (size_t i = 1; i < maps.size(); ++i)
        for (size_t k = i; k-- > 0;)
            maps[i]->shareLayout(*maps[k]);
    data.deformation = deformationOf(haptic);
    data.shading = shadingOf(haptic.forceShading);
    return data;
}

} // namespace touchstone

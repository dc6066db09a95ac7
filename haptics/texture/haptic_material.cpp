#include "haptics/texture/haptic_material.h"

#include <algorithm>
#include <string>

namespace touchstone {

namespace {

/// The map of a texture reference, or an empty map with a warning when its image could not be read.
HapticMap mapOf(const Scene& scene, const TextureRef& reference, int channels, const std::string& place,
                std::vector<Warning>& warnings) {
    if (!reference)
        return {};
    const Image& image = scene.images[static_cast<size_t>(reference.image)];
    if (image.pixels.bytes.empty()) {
        if (!image.problem.empty())
            warnings.push_back({place, "not felt: " + image.problem});
        return {};
    }
    return {image.pixels, reference, channels};
}

HapticFactor factorOf(const Scene& scene, const HapticMaterial::Field<FactorMap>& field,
                      const std::string& place, std::vector<Warning>& warnings) {
    HapticFactor factor;
    if (!field.value)
        return factor;
    factor.map = mapOf(scene, field.value->texture, 1, place, warnings);
    factor.min = static_cast<double>(field.value->min);
    factor.max = static_cast<double>(field.value->max);
    return factor;
}

double numberOr(const HapticMaterial::Field<float>& field, double otherwise) {
    return field.value ? static_cast<double>(*field.value) : otherwise;
}

/// "bezier" is kept for later work and felt as two-pass; the import tells so.
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
    case ShadingChoice::Bezier:
        break;
    }
    return ShadingMode::TwoPass;
}

} // namespace

HapticMaterialData buildHapticMaterial(const Scene& scene, int index, std::vector<Warning>& warnings) {
    const Material& material = scene.materials[static_cast<size_t>(index)];
    const HapticMaterial& haptic = material.haptic;
    const std::string place = "materials[" + std::to_string(index) + "]";
    HapticMaterialData data;
    data.stiffness = numberOr(haptic.stiffness, NAN);
    data.damping = numberOr(haptic.damping, NAN);
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
    if (influence > 0.0)
        data.normal = mapOf(scene, material.normalTexture, 3, place + ".normalTexture", warnings);
    data.normalScale = static_cast<double>(material.normalScale) * influence;
    if (haptic.height.value) {
        data.height = mapOf(scene, haptic.height.value->texture, 1, place + ".heightTexture", warnings);
        data.heightScale = static_cast<double>(haptic.height.value->scale);
    }
    data.friction = factorOf(scene, haptic.friction, place + ".frictionTexture", warnings);
    data.stiffnessMap = factorOf(scene, haptic.stiffnessMap, place + ".stiffnessTexture", warnings);
    data.dampingMap = factorOf(scene, haptic.dampingMap, place + ".dampingTexture", warnings);
    data.shading = shadingOf(haptic.forceShading);
    // Told, never silently ignored: read and kept, and the tick does not know it yet.
    if (haptic.sides == SideChoice::Front)
        warnings.push_back({place, "sides: front is not yet available; both sides are touchable"});
    return data;
}

} // namespace touchstone

#include "engine/scene/haptic_layers.h"

#include "engine/core/error.h"
#include "engine/scene/haptic_numbers.h"

#include <algorithm>
#include <utility>

namespace touchstone {

namespace {

/// A field keeps its first value: layers come in falling order of precedence.
template <class T>
void offer(HapticMaterial::Field<T>& field, const std::optional<T>& value, HapticSource source) {
    if (!field.value && value)
        field = {value, source};
}

/// None where the program has a flaw; the import has reported it.
MaterialProgram feltProgram(const HapticStatement& ours) {
    if (ours.program == nullptr)
        return {};
    try {
        return materialProgram(ours.program, ours.shader);
    } catch (const Error&) {
        return {};
    }
}

void offerOurs(const HapticStatement& ours, HapticMaterial& haptic) {
    constexpr auto source = HapticSource::Touchstone;
    for (const HapticNumber& number : hapticNumbers())
        if (number.settled != nullptr)
            offer(haptic.*number.settled, ours.*number.stated, source);
    offer(haptic.height, ours.height, source);
    offer(haptic.friction, ours.friction, source);
    offer(haptic.stiffnessMap, ours.stiffnessMap, source);
    offer(haptic.dampingMap, ours.dampingMap, source);
    haptic.forceShading = ours.forceShading.value_or(ShadingChoice::Auto);
    haptic.sides = ours.sides.value_or(SideChoice::Both);
    haptic.implicit = ours.implicit.value_or(false);
    haptic.voxelSize = ours.voxelSize.value_or(0.0f);
    haptic.fieldError = ours.fieldError.value_or(0.0f);
    haptic.fieldTexture = {.noiseAmplitude = ours.noiseAmplitude.value_or(0.0f),
                           .noiseWavelength = ours.noiseWavelength.value_or(0.0f),
                           .noiseSeed = ours.noiseSeed.value_or(0.0f),
                           .latticeAmplitude = ours.latticeAmplitude.value_or(0.0f),
                           .latticeWavelength = ours.latticeWavelength.value_or(0.0f)};
    haptic.program = feltProgram(ours);
    if (!ours.shader.is_null() && !haptic.program)
        haptic.unavailable["shader"] = ours.shader;
}

void offerMpeg(const HapticLayers& says, HapticMaterial& haptic) {
    constexpr auto source = HapticSource::Mpeg;
    const HapticStatement& ours = says.ours;
    offer(haptic.stiffnessMap, says.mpegStiffness, source);
    // The map is the coefficient itself, so its scalars are 1; together with a scalar of the project's
    // extension it would have another meaning.
    if (says.mpegFriction && !ours.staticFriction && !ours.dynamicFriction && !ours.friction) {
        offer(haptic.friction, says.mpegFriction, source);
        offer(haptic.staticFriction, std::optional(1.0f), source);
        offer(haptic.dynamicFriction, std::optional(kSlidingShare), source);
    }
    if (!says.mpegUnavailable.is_null())
        haptic.unavailable["MPEG_haptic_material"] = says.mpegUnavailable;
}

template <class Map>
void dropIfBroken(const std::vector<Image>& images, HapticMaterial::Field<Map>& field) {
    if (field.value && !images[static_cast<size_t>(field.value->texture.image)].problem.empty())
        field = {};
}

} // namespace

HapticMaterial statedHaptics(const HapticLayers& says) {
    HapticMaterial haptic;
    offerOurs(says.ours, haptic);
    offerMpeg(says, haptic);
    offer(haptic.staticFriction, says.physicsStatic, HapticSource::Physics);
    offer(haptic.dynamicFriction, says.physicsDynamic, HapticSource::Physics);
    return haptic;
}

void deriveFriction(HapticMaterial& haptic, std::optional<float> meanRoughness) {
    if (!meanRoughness)
        return;
    const float rough = 0.15f + 0.6f * std::clamp(*meanRoughness, 0.0f, 1.0f);
    // Beside a stated coefficient the derived one must keep mu_d <= mu_s.
    const float fromStatic = haptic.staticFriction.value.value_or(rough);
    offer(haptic.dynamicFriction, std::optional(std::min(kSlidingShare * rough, fromStatic)),
          HapticSource::DerivedFromPbr);
    offer(haptic.staticFriction, std::optional(std::max(rough, *haptic.dynamicFriction.value)),
          HapticSource::DerivedFromPbr);
}

HapticMaterial settledHaptics(const HapticLayers& says, const std::vector<Image>& images) {
    HapticMaterial haptic = statedHaptics(says);
    dropIfBroken(images, haptic.height);
    dropIfBroken(images, haptic.friction);
    dropIfBroken(images, haptic.stiffnessMap);
    dropIfBroken(images, haptic.dampingMap);
    deriveFriction(haptic, says.meanRoughness);
    return haptic;
}

} // namespace touchstone

#include "workbench/editor/presets.h"

#include <algorithm>
#include <array>

namespace touchstone {

namespace {

// Stiffness: a device renders 1 to 3 kN/m before it vibrates, while a real glass plate has a thousand times
// that. So hard materials use the device's maximum (it clamps to its limit), and only soft ones differ.
constexpr std::array kPresets{
    MaterialPreset{"glass", 3000.0f, 0.0f, 0.15f, 0.12f, 0.0f, 0.0f,
                   "as hard as the device can; friction as derived for a mirror (roughness 0); polished: no "
                   "bump height"},
    MaterialPreset{
        "wood", 2000.0f, 0.0f, 0.45f, 0.3f, 0.0f, 1.0f,
        "textbooks give 0.25 to 0.5 and 0.2 to 0.3 for dry wood on wood; less hard than glass; the "
        "grain of a normal map is felt"},
    MaterialPreset{
        "rubber", 500.0f, 2.0f, 1.0f, 0.8f, 0.0f, 1.0f,
        "textbooks give 1.0 and 0.8 for rubber on dry concrete; soft, and keeps the energy that it takes: "
        "damping"},
    MaterialPreset{"sandpaper", 1500.0f, 0.0f, 0.75f, 0.6f, 0.0f, 1.0f,
                   "friction as derived for roughness 1; grit on paper gives way a little"},
    MaterialPreset{
        "felt", 150.0f, 1.0f, 0.29f, 0.22f, 1.0f, 0.3f,
        "0.29 and 0.22 for wood on felt (The Physics Hypertextbook, Friction); the softest; fibres "
        "drag with speed and hide most of the bump height"},
    MaterialPreset{"ice", 2500.0f, 0.0f, 0.1f, 0.03f, 0.2f, 0.0f,
                   "textbooks give 0.1 and 0.03 for ice on ice; the film of water drags with speed; no "
                   "bump height"}};

std::optional<float> unlessDefault(float value, float unset) {
    return value == unset ? std::nullopt : std::optional(value);
}

} // namespace

std::span<const MaterialPreset> materialPresets() {
    return kPresets;
}

const MaterialPreset* findPreset(std::string_view name) {
    const auto found = std::find_if(kPresets.begin(), kPresets.end(),
                                    [&](const MaterialPreset& preset) { return preset.name == name; });
    return found == kPresets.end() ? nullptr : &*found;
}

HapticStatement withPreset(HapticStatement statement, const MaterialPreset& preset) {
    statement.stiffness = preset.stiffness;
    statement.damping = unlessDefault(preset.damping, 0.0f);
    statement.staticFriction = preset.staticFriction;
    statement.dynamicFriction = preset.dynamicFriction;
    statement.viscousFriction = unlessDefault(preset.viscousFriction, 0.0f);
    statement.normalTextureInfluence = unlessDefault(preset.normalTextureInfluence, 1.0f);
    return statement;
}

const MaterialPreset* presetOf(const HapticStatement& statement) {
    const auto found = std::find_if(kPresets.begin(), kPresets.end(), [&](const MaterialPreset& preset) {
        return withPreset(statement, preset) == statement;
    });
    return found == kPresets.end() ? nullptr : &*found;
}

} // namespace touchstone

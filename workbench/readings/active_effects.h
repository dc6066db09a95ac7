#pragma once

#include "haptics/settings/effect_plan.h"
#include "haptics/settings/haptic_settings.h"

#include <string>
#include <vector>

namespace touchstone {

/// An effect of a material as the session feels it: the plan says what the scene calls for, the settings may
/// switch that off, replace it, or add to it.
struct ActiveEffect {
    enum class State : uint8_t {
        On,
        SwitchedOff, ///< the scene calls for it, the settings do without it
        Absent       ///< the scene does not call for it
    };
    Effect effect = Effect::ForceShading;
    State state = State::Absent;
    std::string reason; ///< "normal map, felt share 100 %", "Texture is switched off (F6)"
};

/// Those of one material: On first, then SwitchedOff, then Absent, each in the order of the plan.
[[nodiscard]] std::vector<ActiveEffect> activeEffects(const EffectPlan& plan, int material,
                                                      const HapticSettings& settings);

} // namespace touchstone

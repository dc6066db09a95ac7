#pragma once

#include "workbench/panels/panel_state.h"

namespace touchstone {

/// Switch of an effect with several modes: it returns to its last mode.
template <class Mode>
struct EffectSwitch {
    Mode HapticSettings::*mode;
    Mode off, usual; ///< `usual`: where it was never on

    [[nodiscard]] bool on(const PanelState& state) const { return state.settings.*mode != off; }
    /// Every frame, so that a mode chosen elsewhere is remembered, too.
    void remember(PanelState& state) const {
        if (on(state))
            state.chosen.*mode = state.settings.*mode;
    }
    void toggle(PanelState& state) const {
        remember(state);
        state.settings.*mode = on(state) ? off : state.chosen.*mode != off ? state.chosen.*mode : usual;
    }
};

inline constexpr EffectSwitch<ShadingMode> kShadingSwitch{&HapticSettings::forceShading, ShadingMode::Off,
                                                          ShadingMode::Material};
inline constexpr EffectSwitch<TextureMode> kTextureSwitch{&HapticSettings::texture, TextureMode::Off,
                                                          TextureMode::Law};
inline constexpr EffectSwitch<FrictionMode> kFrictionSwitch{&HapticSettings::friction, FrictionMode::Off,
                                                            FrictionMode::Zilles};

} // namespace touchstone

#include "workbench/readings/active_effects.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace touchstone {

namespace {

using State = ActiveEffect::State;

std::string number(const char* format, double value) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), format, value);
    return text.data();
}

/// What the settings make of an effect; an empty reason: they leave it to the plan.
struct Ruling {
    State state = State::On;
    std::string reason;
};

Ruling texture(const HapticSettings& settings, bool planned) {
    if (!planned)
        return {};
    if (settings.texture == TextureMode::Off)
        return {State::SwitchedOff, "Texture is switched off (F6)"};
    if (settings.textureStrength == 0.0)
        return {State::SwitchedOff, "the texture strength is 0"};
    return {};
}

/// A coefficient of the session replaces the material's, also where it states none.
Ruling friction(const HapticSettings& settings, bool planned) {
    if (settings.friction == FrictionMode::Off)
        return planned ? Ruling{State::SwitchedOff, "Friction is switched off (F7)"} : Ruling{};
    if (settings.staticFriction > 0.0)
        return {State::On, number("the session's static coefficient %g", settings.staticFriction)};
    if (settings.staticFriction == 0.0 && planned)
        return {State::SwitchedOff, "the session's static coefficient is 0"};
    return {};
}

Ruling damping(const HapticSettings& settings, bool planned) {
    if (settings.damping > 0.0)
        return {State::On, number("the session's %g N s/m", settings.damping)};
    if (settings.damping == 0.0 && planned)
        return {State::SwitchedOff, "the session's damping is 0"};
    return {};
}

Ruling ruling(Effect effect, bool planned, const HapticSettings& settings) {
    switch (effect) {
    case Effect::ForceShading:
        return planned && settings.forceShading == ShadingMode::Off
                   ? Ruling{State::SwitchedOff, "Shading is switched off (F5)"}
                   : Ruling{};
    case Effect::NormalMap:
    case Effect::HeightMap:
        return texture(settings, planned);
    case Effect::Friction:
        return friction(settings, planned);
    case Effect::ViscousFriction:
        return planned && settings.friction == FrictionMode::Off
                   ? Ruling{State::SwitchedOff, "Friction is switched off (F7)"}
                   : Ruling{};
    case Effect::Damping:
        return damping(settings, planned);
    case Effect::Program:
        return planned && settings.programs == ProgramMode::Off
                   ? Ruling{State::SwitchedOff, "programs=off in the session"}
                   : Ruling{};
    case Effect::LocalDeformation:
        return planned && !settings.deformation ? Ruling{State::SwitchedOff, "deformation=off in the session"}
                                                : Ruling{};
    case Effect::VaryingStiffness:
        break; // a map scales the session's stiffness, too
    }
    return {};
}

} // namespace

std::vector<ActiveEffect> activeEffects(const EffectPlan& plan, int material,
                                        const HapticSettings& settings) {
    std::vector<ActiveEffect> effects;
    for (const PlannedEffect& planned : plan.effects) {
        if (planned.material != material)
            continue;
        const Ruling ruled = ruling(planned.effect, planned.on, settings);
        if (ruled.reason.empty())
            effects.push_back({planned.effect, planned.on ? State::On : State::Absent, planned.reason});
        else
            effects.push_back({planned.effect, ruled.state, ruled.reason});
    }
    std::ranges::stable_sort(effects, {}, &ActiveEffect::state);
    return effects;
}

} // namespace touchstone

#include "workbench/readings/active_effects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace touchstone::active_effects_test {
namespace {

using State = ActiveEffect::State;

/// Material 0 calls for everything, material 1 for nothing.
EffectPlan plan() {
    EffectPlan plan;
    for (const int material : {0, 1})
        for (const Effect effect :
             {Effect::ForceShading, Effect::NormalMap, Effect::HeightMap, Effect::Friction,
              Effect::ViscousFriction, Effect::Damping, Effect::VaryingStiffness})
            plan.effects.push_back({effect, material, material == 0, "as planned", 0});
    return plan;
}

ActiveEffect of(Effect effect, int material, const HapticSettings& settings) {
    const std::vector<ActiveEffect> all = activeEffects(plan(), material, settings);
    EXPECT_EQ(all.size(), 7u);
    return *std::ranges::find(all, effect, &ActiveEffect::effect);
}

TEST(ActiveEffects, AreThePlansWhereTheSettingsSayNothing) {
    for (const ActiveEffect& effect : activeEffects(plan(), 0, {})) {
        EXPECT_EQ(effect.state, State::On);
        EXPECT_EQ(effect.reason, "as planned");
    }
    for (const ActiveEffect& effect : activeEffects(plan(), 1, {}))
        EXPECT_EQ(effect.state, State::Absent);
    EXPECT_TRUE(activeEffects(plan(), 2, {}).empty());
}

TEST(ActiveEffects, EachSwitchTakesItsOwn) {
    struct Case {
        HapticSettings settings;
        std::vector<Effect> off;
        const char* key;
    };
    Case shading{{}, {Effect::ForceShading}, "F5"}, texture{{}, {Effect::NormalMap, Effect::HeightMap}, "F6"},
        friction{{}, {Effect::Friction, Effect::ViscousFriction}, "F7"};
    shading.settings.forceShading = ShadingMode::Off;
    texture.settings.texture = TextureMode::Off;
    friction.settings.friction = FrictionMode::Off;
    for (const Case& c : {shading, texture, friction})
        for (const ActiveEffect& effect : activeEffects(plan(), 0, c.settings)) {
            const bool off = std::ranges::find(c.off, effect.effect) != c.off.end();
            EXPECT_EQ(effect.state, off ? State::SwitchedOff : State::On) << effectName(effect.effect);
            EXPECT_EQ(effect.reason.find(c.key) != std::string::npos, off) << effect.reason;
        }
    // What the scene does not call for is not switched off.
    for (const ActiveEffect& effect : activeEffects(plan(), 1, friction.settings))
        EXPECT_EQ(effect.state, State::Absent);
}

TEST(ActiveEffects, CoefficientsOfTheSessionReplaceTheMaterials) {
    HapticSettings settings;
    settings.staticFriction = 0.5;
    settings.damping = 2.0;
    for (const int material : {0, 1}) {
        EXPECT_EQ(of(Effect::Friction, material, settings).state, State::On);
        EXPECT_EQ(of(Effect::Friction, material, settings).reason, "the session's static coefficient 0.5");
        EXPECT_EQ(of(Effect::Damping, material, settings).reason, "the session's 2 N s/m");
    }
    settings.staticFriction = settings.damping = settings.textureStrength = 0.0;
    for (const Effect effect : {Effect::Friction, Effect::Damping, Effect::NormalMap}) {
        EXPECT_EQ(of(effect, 0, settings).state, State::SwitchedOff) << effectName(effect);
        EXPECT_EQ(of(effect, 1, settings).state, State::Absent) << effectName(effect);
    }
}

TEST(ActiveEffects, ThoseThatAreOnComeFirst) {
    HapticSettings settings;
    settings.forceShading = ShadingMode::Off;
    const std::vector<ActiveEffect> all = activeEffects(plan(), 0, settings);
    EXPECT_EQ(all.front().effect, Effect::NormalMap);
    EXPECT_EQ(all.back().effect, Effect::ForceShading);
}

} // namespace
} // namespace touchstone::active_effects_test

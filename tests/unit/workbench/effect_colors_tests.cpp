#include "workbench/screen/effect_colors.h"

#include <gtest/gtest.h>

namespace touchstone::effect_colors_tests {
namespace {

EffectPlan planOf(std::initializer_list<std::pair<int, Effect>> on) {
    EffectPlan plan;
    for (const auto& [material, effect] : on)
        plan.effects.push_back({effect, material, true, "", 0});
    plan.effects.push_back({Effect::Damping, 0, false, "", 0});
    return plan;
}

TEST(EffectColors, MaterialsWithTheSameEffectsShareAColour) {
    const EffectColors colors = effectColors(
        planOf({{0, Effect::Friction}, {1, Effect::NormalMap}, {1, Effect::Friction}, {3, Effect::Friction}}),
        4);
    ASSERT_EQ(colors.kinds.size(), 3u);
    EXPECT_EQ(colors.kinds[0].effects, "no effect: contact alone");
    EXPECT_EQ(colors.kinds[1].effects, "friction");
    EXPECT_EQ(colors.kinds[2].effects, "normal map, friction");
    ASSERT_EQ(colors.materials.size(), 4u);
    EXPECT_EQ(colors.materials[0], colors.materials[3]);
    EXPECT_EQ(colors.materials[2], colors.kinds[0].color);
    EXPECT_NE(colors.materials[0], colors.materials[1]);
    EXPECT_EQ(colors.materials[1], colors.kinds[2].color);
}

TEST(EffectColors, GreyIsForNoEffectAlone) {
    const EffectColors plain = effectColors({}, 2);
    const EffectColors rough = effectColors(planOf({{0, Effect::Friction}}), 1);
    ASSERT_EQ(plain.kinds.size(), 1u);
    ASSERT_EQ(rough.kinds.size(), 1u);
    EXPECT_NE(plain.kinds[0].color, rough.kinds[0].color);
    EXPECT_TRUE(effectColors({}, 0).kinds.empty());
}

} // namespace
} // namespace touchstone::effect_colors_tests

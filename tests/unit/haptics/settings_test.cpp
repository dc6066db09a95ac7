#include "haptics/settings/haptic_settings.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <tuple>

namespace touchstone::settings_test {
namespace {

TEST(Settings, EveryNameCanBeReadAndWrittenBack) {
    for (const auto& info : settingFields()) {
        HapticSettings settings;
        const std::string value = settingValue(settings, info.name);
        ASSERT_FALSE(value.empty()) << info.name;
        EXPECT_EQ(setSetting(settings, info.name, value), "") << info.name << "=" << value;
        EXPECT_EQ(settingValue(settings, info.name), value);
    }
}

TEST(Settings, AValueChangesWhatItNames) {
    HapticSettings settings;
    EXPECT_EQ(setSetting(settings, "forceShading", "direction"), "");
    EXPECT_EQ(settings.forceShading, ShadingMode::Direction);
    EXPECT_EQ(setSetting(settings, "textureTiltLimit", "90"), "");
    EXPECT_NEAR(settings.textureTiltLimit, 1.5707963, 1e-6);
    EXPECT_EQ(settingValue(HapticSettings{}, "shadingTiltLimit"), "30");
    for (const char* angle : {"12.5", "0.1", "33.333333333333336"}) { // told and taken, to the last bit
        EXPECT_EQ(setSetting(settings, "shadingTiltLimit", angle), "");
        HapticSettings again;
        EXPECT_EQ(setSetting(again, "shadingTiltLimit", settingValue(settings, "shadingTiltLimit")), "");
        EXPECT_EQ(again.shadingTiltLimit, settings.shadingTiltLimit) << angle;
    }
}

TEST(Settings, AWrongValueIsToldAndChangesNothing) {
    HapticSettings settings;
    const HapticSettings before = settings;
    for (const auto& [name, value] : {std::pair{"stiffness", "-1"},
                                      {"stiffness", "nan"},
                                      {"stiffness", "1e"},
                                      {"stiffness", "5 N"},
                                      {"friction", "sticky"},
                                      {"iterationBudget", "2.5"},
                                      {"forceEnabled", "yes"},
                                      {"colour", "red"},
                                      {"", ""}}) {
        EXPECT_NE(setSetting(settings, name, value), "") << name << "=" << value;
        EXPECT_EQ(settings, before);
    }
    EXPECT_NE(setSetting(settings, "friction", "sticky").find("zilles"), std::string::npos);
}

TEST(Settings, ARangeHoldsItsBoundsAndNothingBeyond) {
    for (const auto& [name, low, high] : {std::tuple{"proxyRadius", 0.0, 0.05},
                                          {"stiffness", 0.0, 1e5},
                                          {"damping", -1.0, 1e3},
                                          {"staticFriction", -1.0, 100.0},
                                          {"dynamicFriction", -1.0, 100.0},
                                          {"shadingTiltLimit", 0.0, 90.0},
                                          {"textureTiltLimit", 0.0, 90.0},
                                          {"textureStrength", 0.0, 1.0},
                                          {"iterationBudget", 1.0, 1000.0}}) {
        const double beyond = std::max(1e-3, 1e-3 * high);
        HapticSettings settings;
        for (const double value : {low, high}) {
            const std::string told = std::to_string(value);
            EXPECT_EQ(setSetting(settings, name, told), "") << name << "=" << told;
            EXPECT_DOUBLE_EQ(std::stod(settingValue(settings, name)), value) << name;
        }
        EXPECT_NE(setSetting(settings, name, std::to_string(low - beyond)), "") << name;
        EXPECT_NE(setSetting(settings, name, std::to_string(high + beyond)), "") << name;
        EXPECT_DOUBLE_EQ(std::stod(settingValue(settings, name)), high) << name << ": unchanged";
    }
}

TEST(Settings, EveryChoiceThatIsListedCanBeMade) {
    for (const auto& field : settingFields())
        for (const std::string_view word : field.words) {
            HapticSettings settings;
            EXPECT_EQ(setSetting(settings, field.name, word), "") << field.name << "=" << word;
            EXPECT_EQ(settingValue(settings, field.name), word);
        }
    EXPECT_EQ(settingValue(HapticSettings{}, "colour"), "");
}

TEST(Settings, WhatDoesNotGoTogetherIsToldOf) {
    const auto warnings = [](HapticSettings settings) { return settingWarnings(settings).size(); };
    HapticSettings settings;
    EXPECT_EQ(warnings(settings), 0u);
    settings.proxyRadius = 0.001;
    EXPECT_EQ(warnings(settings), 0u);
    settings.contact = ContactMethod::Rays;
    EXPECT_EQ(warnings(settings), 1u); // a point method
    settings.proxyRadius = 0.0;
    EXPECT_EQ(warnings(settings), 0u);
    settings.precision = Precision::Single;
    EXPECT_EQ(warnings(settings), 0u);
    settings.contact = ContactMethod::Sweep;
    EXPECT_EQ(warnings(settings), 1u); // rays alone have floats
    settings = {};
    settings.staticFriction = settings.dynamicFriction = 0.3;
    EXPECT_EQ(warnings(settings), 0u);
    settings.staticFriction = 0.0;
    EXPECT_EQ(warnings(settings), 1u); // no dynamic coefficient above the static one, be it nothing
    settings.staticFriction = -1.0;
    EXPECT_EQ(warnings(settings), 0u); // the material's
}

/// forceScale acts on the command alone: contact and its force stay as they are.
TEST(Settings, TheForceScaleScalesTheCommand) {
    for (const double scale : {0.0, 0.25, 1.0}) {
        test::TouchBench bench(test::sceneOf(assets::plane(0.1, 0.1, 3, 3)));
        bench.settings.stiffness = 1000.0;
        bench.settings.forceScale = scale;
        bench.moveTo({0.011, 0.002, 0.007}, 0.1);
        bench.moveTo({0.011, -0.001, 0.007}, 0.1);
        for (int i = 0; i < 200; ++i) // until the force has faded in
            bench.step({0.011, -0.001, 0.007});
        EXPECT_NEAR(bench.output.force.y, 1.0, 1e-3);
        EXPECT_NEAR(bench.output.command.force().y, scale * bench.output.force.y, 1e-12);
    }
}

} // namespace
} // namespace touchstone::settings_test

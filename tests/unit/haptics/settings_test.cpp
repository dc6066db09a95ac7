#include "haptics/settings/haptic_settings.h"

#include <gtest/gtest.h>

namespace touchstone {
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

} // namespace
} // namespace touchstone

// The size of type and widgets: never so large that the window has no room, whatever is asked for.

#include "workbench/figures/ui_scale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace touchstone::test::ui_scale_tests {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST(UiScale, IsTheMonitorsTimesTheUsers) {
    EXPECT_EQ(fittingScale(1.0f, 1.0f, {1280, 800}), 1.0f);
    EXPECT_EQ(fittingScale(2.0f, 1.0f, {1280, 800}), 2.0f);
    EXPECT_EQ(fittingScale(1.0f, 2.0f, {2560, 1440}), 2.0f);
    EXPECT_EQ(fittingScale(0.75f, 2.0f, {2560, 1440}), 1.5f);
    EXPECT_EQ(fittingScale(1.37f, 1.0f, {2560, 1440}), 1.37f) << "exactly what was asked for";
}

TEST(UiScale, LeavesTheWindowItsSmallestLayout) {
    for (const glm::vec2 window : {glm::vec2(640, 400), glm::vec2(900, 600), glm::vec2(1280, 800),
                                   glm::vec2(2560, 1440), glm::vec2(3000, 400)})
        for (const float wanted : {1.0f, 2.0f, 3.0f, 4.0f}) {
            const float scale = fittingScale(wanted, 1.0f, window);
            EXPECT_LE(scale, wanted);
            EXPECT_GE(window.x / scale, kMinLayout.x - 1e-3f);
            EXPECT_GE(window.y / scale, kMinLayout.y - 1e-3f);
        }
    EXPECT_EQ(fittingScale(2.0f, 1.0f, {900, 600}), 1.25f) << "in steps of a quarter";
}

TEST(UiScale, IsANumberForAnyArguments) {
    for (const float wanted : {0.0f, -1.0f, 1e9f, kNan, std::numeric_limits<float>::infinity()})
        for (const float monitor : {0.0f, -3.0f, 1.0f, 1e9f})
            for (const glm::vec2 window : {glm::vec2(0, 0), glm::vec2(1, 1), glm::vec2(16384, 16384)}) {
                const float scale = fittingScale(wanted, monitor, window);
                EXPECT_GE(scale, kMinUiScale) << wanted << ' ' << monitor << ' ' << window.x;
                EXPECT_LE(scale, 16384.0f / kMinLayout.y);
            }
}

TEST(UiScale, StepsAreQuartersWithinTheLimits) {
    EXPECT_EQ(steppedUiScale(1.0f, 1), 1.25f);
    EXPECT_EQ(steppedUiScale(1.37f, 1), 1.5f);
    EXPECT_EQ(steppedUiScale(1.37f, -1), 1.25f);
    EXPECT_EQ(steppedUiScale(kMinUiScale, -1), kMinUiScale);
    EXPECT_EQ(steppedUiScale(kMaxUiScale, 1), kMaxUiScale);
}

TEST(UiScale, IsReadFromANumberWithinTheLimitsOnly) {
    float scale = 7.0f;
    for (const char* text : {"", "0", "-1", "1e9", "nan", "inf", "0.74", "4.01", "2x", "two", " 2"}) {
        EXPECT_NE(readUiScale(text, scale).find("0.75 to 4"), std::string::npos) << text;
        EXPECT_EQ(scale, 7.0f);
    }
    EXPECT_EQ(readUiScale("1.5", scale), "");
    EXPECT_EQ(scale, 1.5f);
}

} // namespace
} // namespace touchstone::test::ui_scale_tests

// [001 §4.3.2] of bump maps: "if much more than +-5 deg are used the system is likely to be unstable".

#include "tests/stability/closed_loop/tilted_hold.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

namespace touchstone::test {
namespace {

constexpr double kDegree = 0.017453292519943295;

/// At how many places the hand swings, and the worst swing, m.
std::pair<int, double> swings(const HapticScene& scene, const char* name, const char* value,
                              double HapticSettings::*limit, double degrees, TiltedPlace (*places)(int)) {
    HapticSettings settings;
    EXPECT_EQ(setSetting(settings, name, value), "");
    settings.stiffness = 600.0;
    settings.damping = 0.0;
    settings.friction = FrictionMode::Off;
    settings.*limit = degrees * kDegree;
    std::pair<int, double> result;
    for (int i = 0; i < kTiltedPlaces; i += 3) {
        const TiltedHold held = holdStill(scene, settings, places(i), 4.0);
        result.first += held.swing > kTiltedSwing ? 1 : 0;
        result.second = std::max(result.second, held.swing);
    }
    std::printf("  %s=%s, %g degrees: %d of 8 places swing, %.4f mm at most\n", name, value, degrees,
                result.first, 1e3 * result.second);
    return result;
}

TEST(TiltLimit, BlinnsBumpsThrowAHandToAndFroBeyondTheFiveDegreesOfThePaper) {
    const BenchScene waves = tiltedWaves();
    const auto with = [&](const char* law, double degrees) {
        return swings(*waves.haptic, "texture", law, &HapticSettings::textureTiltLimit, degrees, onWaves);
    };
    EXPECT_EQ(with("blinn", 5.0).first, 0);
    EXPECT_EQ(with("blinn", 10.0).first, 8);
    EXPECT_GT(with("blinn", 25.0).second, 4.0 * kTiltedSwing);
    EXPECT_LT(with("law", 25.0).second, 0.01 * kTiltedSwing) << "the displacement law rests at the default";
    EXPECT_LT(with("law", 90.0).second, 0.01 * kTiltedSwing);
}

TEST(TiltLimit, ShadedNormalsHoldStillUpToTheDefaultAndBeyondIt) {
    const BenchScene prism = tiltedPrism();
    for (const char* mode : {"twoPass", "bezier", "singleRound", "direction"})
        EXPECT_EQ(
            swings(*prism.haptic, "forceShading", mode, &HapticSettings::shadingTiltLimit, 30.0, onPrism)
                .first,
            0)
            << mode;
}

} // namespace
} // namespace touchstone::test

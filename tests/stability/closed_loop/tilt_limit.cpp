// tilt_limit: how far a hand that holds still is thrown to and fro, over the limits of tilt. A Phantom
// Premium 1.5 in a light grip rests on steep waves of a bump map (textureTiltLimit) and on a prism of four
// sides that is shaded round (shadingTiltLimit), at 24 places each. Blocks on stdout, apart by two empty
// lines as gnuplot's `index` wants them; tools/figure_tilt_limit draws them.
//
// Each line: limit in degrees; worst swing of the device in the last second, mm; how many of the places swing
// by more than three steps of the sensor; largest mean power of the motors less the device's friction, mW.

#include "engine/core/float_mode.h"
#include "tests/stability/closed_loop/tilted_hold.h"

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <string>

namespace {

using namespace touchstone;
using namespace touchstone::test;

constexpr double kLimits[]{1, 2, 3, 5, 7, 10, 15, 20, 25, 30, 40, 50, 60, 90};
constexpr double kPushes[]{1.0, 2.0, 4.0}; // N

void series(const std::string& name, const HapticScene& scene, HapticSettings settings,
            double HapticSettings::*limit, TiltedPlace (*places)(int)) {
    settings.stiffness = 600.0;
    settings.damping = 0.0;
    settings.friction = FrictionMode::Off;
    for (const double push : kPushes) {
        std::printf("# %s, pressed with %g N\n", name.c_str(), push);
        for (const double degrees : kLimits) {
            settings.*limit = degrees * std::numbers::pi / 180.0;
            double swing = 0.0, power = 0.0;
            int swings = 0;
            for (int i = 0; i < kTiltedPlaces; ++i) {
                const TiltedHold held = holdStill(scene, settings, places(i), push);
                swing = std::max(swing, held.swing);
                power = std::max(power, held.power);
                swings += held.swing > kTiltedSwing ? 1 : 0;
            }
            std::printf("%g %.4f %d %.4f\n", degrees, 1e3 * swing, swings, 1e3 * power);
        }
        std::printf("\n\n");
    }
}

} // namespace

int main() {
    enterFloatMode();
    const BenchScene waves = tiltedWaves(), prism = tiltedPrism();
    for (const TextureMode mode : {TextureMode::Blinn, TextureMode::Law}) {
        HapticSettings settings;
        settings.texture = mode;
        series(settingValue(settings, "texture"), *waves.haptic, settings, &HapticSettings::textureTiltLimit,
               onWaves);
    }
    for (const ShadingMode mode : {ShadingMode::TwoPass, ShadingMode::SingleRound, ShadingMode::Direction}) {
        HapticSettings settings;
        settings.forceShading = mode;
        series(settingValue(settings, "forceShading"), *prism.haptic, settings,
               &HapticSettings::shadingTiltLimit, onPrism);
    }
}

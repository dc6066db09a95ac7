#include "study/rate/rate_ablation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace touchstone::study::test {
namespace {

/// Jury's condition on x / u = (g z + c) / (z² - (1 + a) z + a) with a = exp(-b T / m): stable below (1 - a)
/// / c.
double exactLimit(const PlantParameters& device, double rateHz) {
    const double b = device.viscousFriction, t = 1.0 / rateHz, tau = device.mass / b,
                 e = -std::expm1(-t / tau), a = 1.0 - e;
    const double g = (t - tau * e) / b, c = tau * e * e / b - a * g;
    return (1.0 - a) / c;
}

TEST(RateAblation, FindsTheWallThatTheEigenvaluesSay) {
    for (const double rate : kServoRates) {
        const PlantParameters device = pressingDevice();
        const double stiffest = stiffestStable(device, rate);
        EXPECT_NEAR(stiffest / exactLimit(device, rate), 1.0, 2e-3) << rate << " Hz";
        EXPECT_GT(stiffest, stiffnessBound(device, rate));
        EXPECT_LT(stiffest, 1.06 * stiffnessBound(device, rate));
    }
}

TEST(RateAblation, FindsNoWallForADeviceThatTakesNoEnergy) {
    PlantParameters device = pressingDevice();
    device.delay = 1;
    EXPECT_LT(stiffestStable(device, 1000.0), 0.5 * stiffnessBound(device, 1000.0));
    device = pressingDevice();
    device.viscousFriction = 1e-9; // a bound of a hair; and damping too little to be seen to take anything
    EXPECT_LT(stiffestStable(device, 1000.0), 1.0);
}

TEST(RateAblation, StrokesAtEachRate) {
    const double rates[]{500.0, 2000.0};
    double done = 0.0;
    const auto results =
        studyRates(rates, {.rounds = 3, .seconds = 0.5}, [&](double fraction) { done = fraction; });
    ASSERT_EQ(results.size(), 2u);
    EXPECT_EQ(done, 1.0);
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(results[i].rateHz, rates[i]);
        EXPECT_GT(results[i].busy.low, 0.0);
        EXPECT_LE(results[i].busy.low, results[i].busy.value);
        EXPECT_LE(results[i].busy.value, results[i].busy.high);
        // A Phantom in a light grip is given next to nothing by a wall of 600 N/m.
        EXPECT_LT(results[i].energyCreated, 1e-3);
    }
}

} // namespace
} // namespace touchstone::study::test

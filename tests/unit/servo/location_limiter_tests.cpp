// A contact location never leaves the pad and never moves faster than its display.

#include "engine/device_io/servo_silence.h"
#include "haptics/safety/location_limiter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace touchstone::location_limiter_tests {
namespace {

constexpr PadLimits kPad{.reach = 0.008, .rate = 0.1};

glm::dvec2 shown(const glm::dvec2& wanted, bool touching, const PadLimits& limits,
                 LocationLimiterState& state) {
    return LocationLimiter::limit(
               {.wanted = wanted, .touching = touching, .forceFelt = true, .limits = limits, .dt = 1e-3},
               state)
        .location();
}

TEST(LocationLimiter, AMillionRandomTicksKeepRangeAndRate) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    LocationLimiterState state;
    glm::dvec2 before(0.0);
    double worstRange = 0.0, worstRate = 0.0;
    size_t moved = 0;
    glm::dvec2 place(0.0);
    for (int i = 0; i < 1'000'000; ++i) {
        if (random() % 200 == 0) // some places are held until they are reached
            place = 0.02 * glm::dvec2(unit(random), unit(random));
        glm::dvec2 wanted = random() % 10 == 0 ? 0.02 * glm::dvec2(unit(random), unit(random)) : place;
        switch (random() % 100) {
        case 0:
            wanted.x = NAN;
            break;
        case 1:
            wanted.y = INFINITY;
            break;
        case 2:
            wanted *= 1e300;
            break;
        default:
            break;
        }
        const uint64_t kind = random() % 200;
        const double dt = kind == 0 ? 10.0 : kind == 1 ? NAN : kind == 2 ? -1.0 : 1e-3 * (1.0 + unit(random));
        const bool felt = random() % 20 != 0;
        const glm::dvec2 now = LocationLimiter::limit({.wanted = wanted,
                                                       .touching = random() % 10 != 0,
                                                       .forceFelt = felt,
                                                       .limits = kPad,
                                                       .dt = dt},
                                                      state)
                                   .location();
        ASSERT_TRUE(felt || now == before) << i << ": moved without force";
        ASSERT_TRUE(std::isfinite(now.x) && std::isfinite(now.y)) << i;
        const double most = dt > 0.0 ? kPad.rate * std::min(dt, kServoSilence) : 0.0;
        const double step = glm::length(now - before);
        ASSERT_LE(glm::length(now), kPad.reach) << i;
        ASSERT_LE(step, most * (1.0 + 1e-12) + 1e-17) << i; // rounding of places of 8 mm
        worstRange = std::max(worstRange, glm::length(now));
        worstRate = std::max(worstRate, most > 0.0 ? step / most : 0.0);
        moved += step > 0.0 ? 1 : 0;
        before = now;
    }
    std::printf("at most %.9g of the reach, %.9g of the rate; %zu of 1000000 ticks moved it\n",
                worstRange / kPad.reach, worstRate, moved);
    EXPECT_GT(worstRange, 0.9 * kPad.reach) << "the whole pad was used";
    EXPECT_GT(moved, 400'000u);
}

TEST(LocationLimiter, StaysInTheAirAndReachesAPlaceInContact) {
    LocationLimiterState state;
    const glm::dvec2 place(0.003, -0.002);
    for (int i = 0; i < 100; ++i)
        (void)shown(place, true, kPad, state);
    EXPECT_EQ(state.last, place) << "exactly, once it is within a step";
    EXPECT_EQ(shown({0.0, 0.0}, false, kPad, state), place);
}

TEST(LocationLimiter, HoldsWithoutForceAndGoesOnFromThereAtItsRate) {
    LocationLimiterState state;
    for (int i = 0; i < 10; ++i)
        (void)shown({0.005, 0.0}, true, kPad, state);
    const glm::dvec2 held = state.last;
    ASSERT_GT(held.x, 0.0);
    ASSERT_LT(held.x, 0.005) << "still on its way";
    for (int i = 0; i < 1000; ++i)
        ASSERT_EQ(
            LocationLimiter::limit(
                {.wanted = {-0.005, 0.002}, .touching = true, .forceFelt = false, .limits = kPad, .dt = 1e-3},
                state)
                .location(),
            held)
            << i;
    const glm::dvec2 next = shown({-0.005, 0.002}, true, kPad, state);
    EXPECT_NEAR(glm::length(next - held), kPad.rate * 1e-3, 1e-15);
}

TEST(LocationLimiter, ADeviceWithoutAPadGetsNone) {
    LocationLimiterState state;
    state.last = {0.005, 0.0};
    EXPECT_EQ(shown({0.004, 0.0}, true, {}, state), glm::dvec2(0.0));
    EXPECT_EQ(shown({0.004, 0.0}, true, {.reach = NAN, .rate = 1.0}, state), glm::dvec2(0.0));
    // A smaller display takes over: the place is cut at once.
    (void)shown({0.008, 0.0}, true, {.reach = 0.008, .rate = 100.0}, state);
    EXPECT_LE(glm::length(shown({0.008, 0.0}, true, {.reach = 0.002, .rate = 1e-6}, state)), 0.002);
}

} // namespace
} // namespace touchstone::location_limiter_tests

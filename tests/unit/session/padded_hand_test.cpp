// In a scene the pad's location follows from normal and orientation, through the safety stage.

#include "session/padded_hand.h"

#include <gtest/gtest.h>

namespace touchstone {
namespace {

struct Hand final : Device {
    PadLimits limitsOfPad{.reach = 0.008, .rate = 10.0};
    DeviceSample next{.valid = true};
    glm::dvec2 shown{0.0};
    int shows = 0, forces = 0;

    [[nodiscard]] std::string name() const override { return "test"; }
    [[nodiscard]] DeviceLimits limits() const override { return {}; }
    [[nodiscard]] PadLimits pad() const noexcept override { return limitsOfPad; }
    [[nodiscard]] DeviceSample sample(double) noexcept override { return next; }
    void apply(const DeviceCommand&) noexcept override { ++forces; }
    void applyPad(const PadCommand& command) noexcept override {
        shown = command.location();
        ++shows;
    }
};

void tick(PaddedHand& hand, double time, bool touching, const glm::dvec3& normal) {
    hand.feel({.touching = touching, .hip = {0.0, 0.0, 0.0}, .proxy = 1e-3 * normal});
    (void)hand.sample(time);
    hand.apply({});
}

TEST(PaddedHand, ShowsWhereThePadTouches) {
    Hand inner;
    PaddedHand hand(inner);
    const glm::dvec3 tilted(std::sin(0.2), std::cos(0.2), 0.0);
    for (int i = 1; i < 20; ++i)
        tick(hand, 1e-3 * i, true, tilted);
    EXPECT_NEAR(inner.shown.x, -0.2 * 0.02, 1e-12);
    EXPECT_NEAR(inner.shown.y, 0.0, 1e-12);
    EXPECT_EQ(hand.shown(), inner.shown);
    inner.next.orientation =
        glm::angleAxis(-0.2, glm::dvec3(0.0, 0.0, 1.0)); // pitched along with the surface
    for (int i = 20; i < 40; ++i)
        tick(hand, 1e-3 * i, true, tilted);
    EXPECT_NEAR(glm::length(inner.shown), 0.0, 1e-12);
    tick(hand, 0.04, false, {1.0, 0.0, 0.0});
    EXPECT_NEAR(glm::length(inner.shown), 0.0, 1e-12) << "stays in the air";
    EXPECT_EQ(inner.forces, inner.shows);
    const PadLimits limits = inner.limitsOfPad;
    inner.limitsOfPad = {};
    const int shows = inner.shows;
    tick(hand, 0.041, true, tilted);
    EXPECT_EQ(inner.shows, shows + 1) << "what comes next begins in its middle";
    EXPECT_EQ(inner.shown, glm::dvec2(0.0));
    tick(hand, 0.042, true, tilted);
    EXPECT_EQ(inner.shows, shows + 1) << "no display, no command";
    // The next display goes there at its own rate, wherever this one was.
    inner.limitsOfPad = limits;
    tick(hand, 0.043, true, {1.0, 0.0, 0.0});
    EXPECT_GT(glm::length(inner.shown), 0.0);
    EXPECT_LE(glm::length(inner.shown), limits.rate * 1e-3);
}

} // namespace
} // namespace touchstone

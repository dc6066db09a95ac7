// The pad in space: the arc finger where it is turned in the plane alone, continuous everywhere else.

#include "haptics/finger/arc_finger.h"
#include "haptics/finger/finger_pad.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace touchstone {
namespace {

TEST(FingerPad, InThePlaneItIsTheArcFinger) {
    const FingerPad pad;
    const ArcFinger arc;
    for (double pitch = -0.6; pitch <= 0.6; pitch += 0.05)
        for (double lean = -0.7; lean <= 0.7; lean += 0.05) {
            const glm::dvec2 normal(std::sin(lean), std::cos(lean));
            const glm::dvec2 at =
                pad.locationOn(glm::angleAxis(pitch, glm::dvec3(0.0, 0.0, 1.0)), glm::dvec3(normal, 0.0));
            EXPECT_NEAR(at.x, arc.locationTowards({.pitch = pitch}, -normal), 1e-15) << pitch << " " << lean;
            EXPECT_NEAR(at.y, 0.0, 1e-15);
        }
}

TEST(FingerPad, PitchAndRollMoveItAlongAndAcross) {
    const FingerPad pad;
    const glm::dvec3 up(0.0, 1.0, 0.0);
    const glm::dvec2 pitched = pad.locationOn(glm::angleAxis(0.2, glm::dvec3(0.0, 0.0, 1.0)), up);
    EXPECT_NEAR(pitched.x, -0.2 * pad.radius, 1e-15);
    EXPECT_NEAR(pitched.y, 0.0, 1e-15);
    const glm::dvec2 rolled = pad.locationOn(glm::angleAxis(0.2, glm::dvec3(1.0, 0.0, 0.0)), up);
    EXPECT_NEAR(rolled.x, 0.0, 1e-15);
    EXPECT_NEAR(std::abs(rolled.y), 0.2 * pad.radius, 1e-15);
    const glm::dvec2 turned = pad.locationOn(glm::angleAxis(0.2, up), up);
    EXPECT_NEAR(glm::length(turned), 0.0, 1e-15) << "yaw turns the pad in its own place";
}

TEST(FingerPad, StaysOnThePadAndDoesNotJump) {
    const FingerPad pad;
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 100000; ++i) {
        const glm::dquat turn =
            glm::normalize(glm::dquat(normal(random), normal(random), normal(random), normal(random)));
        const glm::dvec3 n = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
        const glm::dvec2 at = pad.locationOn(turn, n);
        ASSERT_LE(glm::length(at), pad.reach * (1.0 + 1e-15));
        // A small turn of the normal moves it by at most that angle times the radius, but where the nail
        // faces the surface.
        const glm::dvec3 axis = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
        const double angle = 1e-4;
        const glm::dvec3 back = glm::conjugate(turn) * n;
        if (back.y < -0.9)
            continue;
        ASSERT_LE(glm::length(pad.locationOn(turn, glm::angleAxis(angle, axis) * n) - at),
                  1.05 * angle * pad.radius);
    }
}

} // namespace
} // namespace touchstone

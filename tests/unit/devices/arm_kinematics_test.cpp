#include "devices/hid/arm_kinematics.h"
#include "devices/hid/device_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace touchstone {
namespace {

constexpr double kPi = std::numbers::pi;

ArmKinematics arm(const char* name) {
    return *readDeviceFile(std::string(TOUCHSTONE_SOURCE "/devices/files/") + name).arm;
}

/// The closed form of this arm: two links that lean from the vertical by B and C on a base that turns by A,
/// in a frame with x towards the user and z up.
glm::dvec3 woodenByHand(double a, double b, double c) {
    const double reach = 0.205 * std::sin(b) + 0.245 * std::sin(c);
    const glm::dvec3 base(std::cos(a) * reach - 0.220, std::sin(a) * reach,
                          0.205 * std::cos(b) - 0.245 * std::cos(c));
    return {base.y, base.z, base.x};
}

TEST(ArmKinematics, TheWoodenArmIsWhereItsClosedFormSays) {
    const ArmKinematics wooden = arm("woodenhaptics.json");
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> counts(-8000.0, 8000.0);
    for (int i = 0; i < 1000; ++i) {
        const std::array<double, kMaxMotors> at{counts(random), counts(random), counts(random)};
        const auto body = [&](size_t m) { return wooden.motors[m].ratio * 2.0 * kPi * at[m] / 2000.0; };
        const glm::dvec3 expected = woodenByHand(body(0), body(1), body(2));
        EXPECT_NEAR(glm::length(poseOf(wooden, at).position - expected), 0.0, 1e-12);
    }
}

TEST(ArmKinematics, TheJacobianIsTheDerivativeOfThePlace) {
    std::mt19937_64 random(8);
    std::uniform_real_distribution<double> counts(-3000.0, 3000.0);
    for (const char* name : {"woodenhaptics.json", "diy_gantry.json"}) {
        const ArmKinematics chain = arm(name);
        for (int i = 0; i < 200; ++i) {
            const std::array<double, kMaxMotors> at{counts(random), counts(random), counts(random)};
            const ArmPose pose = poseOf(chain, at);
            for (size_t m = 0; m < 3; ++m) {
                auto before = at, after = at;
                const double h = 0.5;
                before[m] -= h;
                after[m] += h;
                const double radians = 2.0 * kPi * 2.0 * h / chain.motors[m].countsPerTurn;
                const glm::dvec3 slope =
                    (poseOf(chain, after).position - poseOf(chain, before).position) / radians;
                EXPECT_NEAR(glm::length(pose.jacobian[m] - slope), 0.0, 1e-7) << name << " motor " << m;
            }
        }
    }
}

TEST(ArmKinematics, CurrentsDoTheWorkOfTheForce) {
    // Virtual work: torque times motor speed is force times hand speed, whatever the way the motors turn.
    const ArmKinematics wooden = arm("woodenhaptics.json");
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int i = 0; i < 1000; ++i) {
        const ArmPose pose = poseOf(wooden, {2000 * unit(random), 2000 * unit(random), 2000 * unit(random)});
        const glm::dvec3 force(unit(random), unit(random), unit(random));
        const Currents currents = currentsOf(wooden, pose, force);
        glm::dvec3 handSpeed(0.0);
        double power = 0.0;
        for (size_t m = 0; m < 3; ++m) {
            const double motorSpeed = unit(random);
            handSpeed += pose.jacobian[m] * motorSpeed;
            power += currents[m] * wooden.motors[m].torqueConstant * motorSpeed;
        }
        EXPECT_NEAR(power, glm::dot(force, handSpeed), 1e-12);
    }
}

TEST(ArmKinematics, AForceBeyondTheMotorsKeepsItsDirection) {
    const ArmKinematics gantry = arm("diy_gantry.json");
    const ArmPose pose = poseOf(gantry, {});
    // 0.03 N·m/A on a pulley of 6 mm: 5 N an ampere, and 1 A is the most.
    const Currents fits = currentsOf(gantry, pose, {2.0, 0.0, -1.0});
    EXPECT_NEAR(fits[0], 0.4, 1e-12);
    EXPECT_NEAR(fits[2], -0.2, 1e-12);
    const Currents cut = currentsOf(gantry, pose, {20.0, 0.0, -10.0});
    EXPECT_NEAR(cut[0], 1.0, 1e-12);
    EXPECT_NEAR(cut[1], 0.0, 1e-12);
    EXPECT_NEAR(cut[2], -0.5, 1e-12);
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()})
        for (const double current : currentsOf(gantry, pose, {1.0, bad, 1.0}))
            EXPECT_EQ(current, 0.0);
}

TEST(ArmKinematics, OrientationTurnsWithTheHinges) {
    ArmKinematics hinge;
    hinge.motors.push_back({.countsPerTurn = 4.0});
    hinge.joints.push_back({.slides = false, .axis = {0, 0, 1}, .drive = {1.0}});
    hinge.tip = {1, 0, 0};
    const ArmPose quarter = poseOf(hinge, {1.0});
    EXPECT_NEAR(glm::length(quarter.position - glm::dvec3(0, 1, 0)), 0.0, 1e-15);
    EXPECT_NEAR(glm::length(quarter.orientation * glm::dvec3(1, 0, 0) - glm::dvec3(0, 1, 0)), 0.0, 1e-15);
    EXPECT_NEAR(resolutionOf(hinge), 2.0 * kPi / 4.0, 1e-12) << "one count at a metre";
}

} // namespace
} // namespace touchstone

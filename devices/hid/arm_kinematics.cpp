#include "devices/hid/arm_kinematics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchstone {

namespace {

/// A joint in its current pose, base frame.
struct StandingJoint {
    glm::dvec3 centre{0.0}, axis{0.0};
};

double radiansOf(const ArmMotor& motor, double count) {
    return 2.0 * std::numbers::pi * count / motor.countsPerTurn;
}

} // namespace

ArmPose poseOf(const ArmKinematics& arm, const std::array<double, kMaxMotors>& counts) {
    const size_t motors = std::min(arm.motors.size(), kMaxMotors);
    std::array<double, kMaxMotors> bodies{};
    for (size_t m = 0; m < motors; ++m)
        bodies[m] = arm.motors[m].home + arm.motors[m].ratio * radiansOf(arm.motors[m], counts[m]);

    std::array<StandingJoint, kMaxJoints> standing;
    const size_t joints = std::min(arm.joints.size(), kMaxJoints);
    glm::dquat baseFromLink(1.0, 0.0, 0.0, 0.0);
    glm::dvec3 at(0.0);
    for (size_t j = 0; j < joints; ++j) {
        const ArmJoint& joint = arm.joints[j];
        double value = 0.0;
        for (size_t m = 0; m < motors; ++m)
            value += joint.drive[m] * bodies[m];
        at += baseFromLink * joint.offset;
        const glm::dvec3 axis = baseFromLink * joint.axis;
        standing[j] = {at, axis};
        if (joint.slides)
            at += value * axis;
        else
            baseFromLink = baseFromLink * glm::angleAxis(value, joint.axis);
    }
    at += baseFromLink * arm.tip;

    ArmPose pose;
    pose.position = arm.deviceFromBase * (at - arm.origin);
    const glm::dquat deviceFromBase = glm::quat_cast(arm.deviceFromBase);
    pose.orientation = glm::normalize(deviceFromBase * baseFromLink * glm::conjugate(deviceFromBase));
    // A hinge rotates the tip about its axis, a slide translates the tip along it.
    for (size_t j = 0; j < joints; ++j) {
        const glm::dvec3 moved =
            arm.deviceFromBase *
            (arm.joints[j].slides ? standing[j].axis : glm::cross(standing[j].axis, at - standing[j].centre));
        for (size_t m = 0; m < motors; ++m)
            pose.jacobian[m] += arm.joints[j].drive[m] * arm.motors[m].ratio * moved;
    }
    return pose;
}

Currents currentsOf(const ArmKinematics& arm, const ArmPose& pose, const glm::dvec3& force) {
    Currents currents{};
    double share = 1.0; // fraction of the force that the weakest motor permits
    for (size_t m = 0; m < std::min(arm.motors.size(), kMaxMotors); ++m) {
        const ArmMotor& motor = arm.motors[m];
        if (!(motor.torqueConstant > 0.0))
            continue;
        currents[m] = glm::dot(pose.jacobian[m], force) / motor.torqueConstant;
        if (!std::isfinite(currents[m]))
            return Currents{};
        if (std::abs(currents[m]) > motor.maxCurrent)
            share = std::min(share, motor.maxCurrent / std::abs(currents[m]));
    }
    for (double& current : currents)
        current *= share;
    return currents;
}

double resolutionOf(const ArmKinematics& arm) {
    const ArmPose home = poseOf(arm, {});
    double longest = 0.0;
    for (size_t m = 0; m < std::min(arm.motors.size(), kMaxMotors); ++m)
        longest = std::max(longest, glm::length(home.jacobian[m]) * radiansOf(arm.motors[m], 1.0));
    return longest;
}

} // namespace touchstone

#pragma once
// From encoder counts to the place of a hand, and from a force on it to the currents of the motors, for any
// chain of hinges and slides that motors drive through fixed ratios (a capstan, a belt, a parallelogram).
// Pure data and pure functions.

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <array>
#include <vector>

namespace touchstone {

inline constexpr size_t kMaxMotors = 6, kMaxJoints = 8;

/// A motor with its encoder; each drives one body of the mechanism.
struct ArmMotor {
    double countsPerTurn = 0.0; ///< > 0, after quadrature
    /// Angle of the body (or its way, m) for one radian of the motor. Negative: they turn against each other.
    double ratio = 1.0;
    double home = 0.0;           ///< rad (or m): the body where the count is zero
    double torqueConstant = 0.0; ///< N·m/A; 0: an encoder without a motor
    double maxCurrent = 0.0;     ///< A, of either sign
};

/// One joint of the chain, in the frame that the joint before it carries; the first in the base frame.
struct ArmJoint {
    bool slides = false;      ///< else a hinge
    glm::dvec3 axis{0, 0, 1}; ///< unit
    glm::dvec3 offset{0.0};   ///< m, from the joint before it (the base's origin) to this one
    /// How each body's angle moves this joint; a parallelogram measures its second link against the base, so
    /// that its hinge moves by the difference.
    std::array<double, kMaxMotors> drive{};
};

struct ArmKinematics {
    std::vector<ArmMotor> motors;   ///< at most kMaxMotors, in the order of the report's counts
    std::vector<ArmJoint> joints;   ///< at most kMaxJoints
    glm::dvec3 tip{0.0};            ///< m, what is held, from the last joint
    glm::dvec3 origin{0.0};         ///< m, in the base frame: where the device frame has its own origin
    glm::dmat3 deviceFromBase{1.0}; ///< rotation
};

struct ArmPose {
    glm::dvec3 position{0.0}; ///< m, device frame
    glm::dquat orientation{1.0, 0.0, 0.0, 0.0};
    /// m/rad of each motor, device frame: the columns of the Jacobian.
    std::array<glm::dvec3, kMaxMotors> jacobian{};
};

using Currents = std::array<double, kMaxMotors>; ///< A

/// Where the hand is. `counts`: one for each motor.
[[nodiscard]] ArmPose poseOf(const ArmKinematics& arm, const std::array<double, kMaxMotors>& counts);

/// The currents that make `force` (N, device frame) at the hand: torque = transposed Jacobian times force.
/// When one would exceed its motor's limit all are scaled down together, so that the force keeps its
/// direction. A force that is not finite gives none.
[[nodiscard]] Currents currentsOf(const ArmKinematics& arm, const ArmPose& pose, const glm::dvec3& force);

/// m: the longest step of the hand for one count of one encoder, at home.
[[nodiscard]] double resolutionOf(const ArmKinematics& arm);

} // namespace touchstone

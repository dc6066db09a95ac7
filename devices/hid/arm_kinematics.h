#pragma once
// Forward kinematics from encoder counts, and motor currents from a force at the tip, for any chain of hinges
// and slides that motors drive through fixed ratios (a capstan, a belt, a parallelogram). Pure data and pure
// functions.

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <array>
#include <vector>

namespace touchstone {

inline constexpr size_t kMaxMotors = 6, kMaxJoints = 8;

/// A motor with its encoder; each drives one body of the mechanism.
struct ArmMotor {
    double countsPerTurn = 0.0; ///< > 0, after quadrature
    /// Angle of the body (or its displacement, m) per radian of the motor. Negative: opposite directions.
    double ratio = 1.0;
    double home = 0.0;           ///< rad (or m): position of the body at count zero
    double torqueConstant = 0.0; ///< N·m/A; 0: an encoder without a motor
    double maxCurrent = 0.0;     ///< A, of either sign
};

/// One joint of the chain, in the frame of the previous joint; the first in the base frame.
struct ArmJoint {
    bool slides = false;      ///< else a hinge
    glm::dvec3 axis{0, 0, 1}; ///< unit
    glm::dvec3 offset{0.0};   ///< m, from the joint before it (the base's origin) to this one
    /// Contribution of each body's angle to this joint. A parallelogram measures its second link against the
    /// base, so its hinge moves by the difference.
    std::array<double, kMaxMotors> drive{};
};

struct ArmKinematics {
    std::vector<ArmMotor> motors;   ///< at most kMaxMotors, in the order of the report's counts
    std::vector<ArmJoint> joints;   ///< at most kMaxJoints
    glm::dvec3 tip{0.0};            ///< m, the held point, from the last joint
    glm::dvec3 origin{0.0};         ///< m, in the base frame: origin of the device frame
    glm::dmat3 deviceFromBase{1.0}; ///< rotation
};

struct ArmPose {
    glm::dvec3 position{0.0}; ///< m, device frame
    glm::dquat orientation{1.0, 0.0, 0.0, 0.0};
    /// m/rad of each motor, device frame: the columns of the Jacobian.
    std::array<glm::dvec3, kMaxMotors> jacobian{};
};

using Currents = std::array<double, kMaxMotors>; ///< A

/// Pose of the tip. `counts`: one for each motor.
[[nodiscard]] ArmPose poseOf(const ArmKinematics& arm, const std::array<double, kMaxMotors>& counts);

/// The currents that produce `force` (N, device frame) at the tip: torque = transposed Jacobian times force.
/// If one exceeds its motor's limit, all are scaled down together, which keeps the direction of the force. A
/// force that is not finite yields zero currents.
[[nodiscard]] Currents currentsOf(const ArmKinematics& arm, const ArmPose& pose, const glm::dvec3& force);

/// m: the largest step of the tip for one count of one encoder, at home.
[[nodiscard]] double resolutionOf(const ArmKinematics& arm);

} // namespace touchstone

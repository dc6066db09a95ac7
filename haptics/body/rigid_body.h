#pragma once
// The state of a rigid body and its mass. Workspace, SI: masses are those of the file, lengths those of the
// workspace.

#include "engine/math/similarity.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace touchstone::body {

/// A rotation and a place. The frame of a body has its origin at the centre of mass and its axes along the
/// principal axes of inertia.
struct Pose {
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 position{0.0};

    [[nodiscard]] glm::dvec3 point(const glm::dvec3& p) const { return position + rotation * p; }
    [[nodiscard]] glm::dvec3 inversePoint(const glm::dvec3& p) const {
        return glm::conjugate(rotation) * (p - position);
    }
    [[nodiscard]] Similarity similarity() const { return {1.0, rotation, position}; }
    /// By the small rotation `turn` (rad, about its direction) and `way`.
    void move(const glm::dvec3& way, const glm::dvec3& turn) {
        position += way;
        const double angle = glm::length(turn);
        if (angle > 0.0)
            rotation = glm::normalize(glm::angleAxis(angle, turn / angle) * rotation);
    }
};

/// One body between two ticks. Plain data: the whole state that a recording keeps.
struct BodyState {
    Pose pose;                ///< workspace from body
    Pose published;           ///< the pose of the last tick, which the hands felt
    glm::dvec3 velocity{0.0}; ///< of the centre of mass, m/s
    glm::dvec3 spin{0.0};     ///< rad/s, workspace
    double quiet = 0.0;       ///< s since it last moved
    double room = 0.0;        ///< m that it may move before its contacts are found anew
    bool awake = true;
    bool stirred = false; ///< it is not where the file puts it
};

/// False where a step has left the numbers, or the workspace by so much that forces would: beyond 1e9 m,
/// 1e6 m/s or 1e9 rad/s.
[[nodiscard]] inline bool isSound(const BodyState& state) {
    const glm::dvec3 &at = state.pose.position, &v = state.velocity, &w = state.spin;
    return glm::dot(at, at) < 1e18 && glm::dot(v, v) < 1e12 && glm::dot(w, w) < 1e18 &&
           glm::dot(state.pose.rotation, state.pose.rotation) < 2.0;
}

/// What does not change.
struct BodyMass {
    double inverse = 0.0;           ///< 1/kg; 0: nothing pushes it
    glm::dvec3 inertia{0.0};        ///< kg m^2, principal; 0 with inverseInertia 0: infinite
    glm::dvec3 inverseInertia{0.0}; ///< 1/(kg m^2)
    double gravityFactor = 1.0;
    double drag = 0.0;   ///< 1/s
    double radius = 0.0; ///< m, of a ball about the centre of mass that holds the body
};

/// Inverse inertia times a vector, workspace.
[[nodiscard]] inline glm::dvec3 turned(const BodyMass& mass, const glm::dquat& rotation,
                                       const glm::dvec3& v) {
    return rotation * (mass.inverseInertia * (glm::conjugate(rotation) * v));
}

/// Kinetic energy, J.
[[nodiscard]] inline double kineticEnergy(const BodyMass& mass, const BodyState& state) {
    const glm::dvec3 own = glm::conjugate(state.pose.rotation) * state.spin;
    const double linear =
        mass.inverse > 0.0 ? 0.5 * glm::dot(state.velocity, state.velocity) / mass.inverse : 0.0;
    return linear + 0.5 * glm::dot(own, mass.inertia * own);
}

} // namespace touchstone::body

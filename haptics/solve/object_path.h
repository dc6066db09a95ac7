#pragma once
// The pose of an object within a tick, of which only the two end poses are known.

#include "engine/math/object_motion.h"

namespace touchstone {

/// The motion of one tick as a screw: at a constant rate about and along one axis, like a turning wheel, a
/// slide or a door, wherever the object's own origin lies. Objects that turn together thus keep their
/// relative poses throughout. With a change of scale the origin moves along the chord instead.
class ObjectPath {
  public:
    ObjectPath() = default;
    explicit ObjectPath(const ObjectMotion& motion) noexcept;

    /// workspaceFromObject at `time` in 0..1. Both ends are the given poses to the last bit.
    [[nodiscard]] Similarity at(double time) const noexcept;
    /// rad, 0..pi: the angle over the whole tick.
    [[nodiscard]] double angle() const noexcept { return angle_; }
    /// Upper bound of the path of any point within `radius` (object units) of the origin, workspace metres.
    [[nodiscard]] double longestWay(double radius) const noexcept;

  private:
    ObjectMotion motion_;
    glm::dvec3 axis_{0.0}; // workspace, unit; zero where nothing turns
    double angle_ = 0.0;
    bool screw_ = false;
    glm::dvec3 arm_{0.0};   // from the screw's axis to the origin at time 0
    glm::dvec3 along_{0.0}; // the translation along the axis
};

} // namespace touchstone

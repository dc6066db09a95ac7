#pragma once
// Where an object is within a tick, of which only the two ends are known.

#include "engine/math/object_motion.h"

namespace touchstone {

/// The motion of one tick as a screw: at an even pace about and along one axis, which is what a turning
/// wheel, a slide and a door do, wherever the object's own origin lies. Objects that turn together so keep
/// their places to one another all the way. With a change of scale the origin goes along the chord instead.
class ObjectPath {
  public:
    ObjectPath() = default;
    explicit ObjectPath(const ObjectMotion& motion) noexcept;

    /// workspaceFromObject at `time` in 0..1. The ends are the given poses to the last bit.
    [[nodiscard]] Similarity at(double time) const noexcept;
    /// rad, 0..pi: the turn of the whole tick.
    [[nodiscard]] double angle() const noexcept { return angle_; }
    /// Workspace metres that no point within `radius` (object units) of the origin goes beyond.
    [[nodiscard]] double longestWay(double radius) const noexcept;

  private:
    ObjectMotion motion_;
    glm::dvec3 axis_{0.0}; // workspace, unit; zero where nothing turns
    double angle_ = 0.0;
    bool screw_ = false;
    glm::dvec3 arm_{0.0};   // from the screw's axis to the origin before
    glm::dvec3 along_{0.0}; // the translation along the axis
};

} // namespace touchstone

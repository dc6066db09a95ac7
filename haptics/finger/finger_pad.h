#pragma once
// The finger of the contact location display in space: the pad is a segment of a sphere, the arc finger
// turned about its middle (docs/fingers.md).

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace touchstone {

/// In the hand's own frame the pad faces -y, its length runs along x and its breadth along z.
struct FingerPad {
    double radius = 0.020; ///< m
    double reach = 0.008;  ///< m of arc from the pad's middle to its rim: 16 mm along, as ArcFinger

    /// m along and across: where a pad that is turned by `orientation` touches a surface of the unit normal
    /// `normal` (into free space, in the frame that `orientation` leads to). The place whose normal is
    /// opposite to it, or the nearest one on the rim. A surface that faces the nail touches the rim towards
    /// the fingertip.
    [[nodiscard]] glm::dvec2 locationOn(const glm::dquat& orientation,
                                        const glm::dvec3& normal) const noexcept;
};

} // namespace touchstone

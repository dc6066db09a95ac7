#pragma once
// The finger of the contact location display [004 §4.1]: an arc of a circle in the plane.

#include <glm/glm.hpp>

namespace touchstone {

/// In the plane, m and rad. `pad` is the middle of the pad's skin. At pitch 0 the pad faces -y and its length
/// runs along +x; pitch turns it counter-clockwise.
struct FingerPose {
    glm::dvec2 pad{0.0};
    double pitch = 0.0;
};

/// A straight surface without end. `normal` is a unit vector into free space.
struct SurfaceLine {
    glm::dvec2 point{0.0};
    glm::dvec2 normal{0.0, 1.0};
};

struct PadContact {
    double location = 0.0; ///< m along the pad from its middle, within half the pad's length
    double depth = 0.0;    ///< m of the pad's deepest point behind the surface; negative in free space
    glm::dvec2 point{0.0}; ///< that point's foot on the surface, m
};

struct ArcFinger {
    double radius = 0.020; ///< m
    double length = 0.016; ///< m of arc

    [[nodiscard]] glm::dvec2 centre(const FingerPose& pose) const noexcept;
    /// The skin at `location` m along the pad.
    [[nodiscard]] glm::dvec2 skin(const FingerPose& pose, double location) const noexcept;
    /// The place on the pad, m, whose direction from the centre comes nearest to `direction`, of any length.
    [[nodiscard]] double locationTowards(const FingerPose& pose, const glm::dvec2& direction) const noexcept;
    /// The deepest point of the pad on a line: where the arc is parallel to it, or the nearer end of the pad.
    [[nodiscard]] PadContact touch(const FingerPose& pose, const SurfaceLine& line) const noexcept;
};

/// z of the cross product.
[[nodiscard]] inline double crossed(const glm::dvec2& a, const glm::dvec2& b) noexcept {
    return a.x * b.y - a.y * b.x;
}

} // namespace touchstone

#include "haptics/finger/finger_pad.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

glm::dvec2 FingerPad::locationOn(const glm::dquat& orientation, const glm::dvec3& normal) const noexcept {
    const glm::dvec3 towards = -(glm::conjugate(orientation) * normal);
    const double sideways = std::hypot(towards.x, towards.z);
    if (!(sideways > 0.0))
        return towards.y > 0.0 ? glm::dvec2(reach, 0.0) : glm::dvec2(0.0);
    // The length of the arc from the pad's middle, which faces -y.
    const double arc = std::min(radius * std::atan2(sideways, -towards.y), reach);
    return arc / sideways * glm::dvec2(towards.x, towards.z);
}

} // namespace touchstone

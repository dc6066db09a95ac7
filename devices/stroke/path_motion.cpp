#include "devices/stroke/path_motion.h"

#include <cmath>
#include <cstddef>

namespace touchstone {

glm::dvec3 PathMotion::at(double share, double time, const glm::dvec3& rest) const noexcept {
    if (parts_.size() == 1 || !std::isfinite(share))
        return parts_.front().at(time).point(rest);
    const auto count = static_cast<double>(parts_.size());
    const double along = (share - std::floor(share)) * count, before = std::floor(along);
    const size_t first = static_cast<size_t>(before) % parts_.size(), second = (first + 1) % parts_.size();
    return glm::mix(parts_[first].at(time).point(rest), parts_[second].at(time).point(rest), along - before);
}

} // namespace touchstone

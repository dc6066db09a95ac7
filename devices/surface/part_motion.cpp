#include "devices/surface/part_motion.h"

#include <cmath>
#include <cstddef>

namespace touchstone {

Similarity PartMotion::at(double time) const noexcept {
    if (samples_.size() < 2 || !(duration_ > 0.0) || !std::isfinite(time))
        return samples_.front();
    const double rounds = time / duration_;
    const double at = (rounds - std::floor(rounds)) * static_cast<double>(samples_.size() - 1);
    const auto before = static_cast<size_t>(at);
    if (before + 1 >= samples_.size())
        return samples_.back();
    const Similarity &a = samples_[before], &b = samples_[before + 1];
    const double t = at - static_cast<double>(before);
    const glm::dquat near = glm::dot(a.rotation, b.rotation) < 0.0 ? -b.rotation : b.rotation;
    return {glm::mix(a.scale, b.scale, t), glm::normalize(a.rotation * (1.0 - t) + near * t),
            glm::mix(a.translation, b.translation, t)};
}

} // namespace touchstone

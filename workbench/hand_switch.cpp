#include "workbench/hand_switch.h"

#include <algorithm>

namespace touchstone {

DeviceSample HandSwitch::sample(double time) noexcept {
    DeviceSample sample = mouse_.sample(time);
    const StrokePath* path = path_.adopt();
    if (!simulated_.load(std::memory_order_relaxed))
        path = nullptr;
    if (path != nullptr) {
        sample.position = path->position(time);
        sample.age = 0.0;
        sample.valid = true;
    }
    if (path != followed_) {
        followed_ = path;
        gliding_ = started_;
        glideFrom_ = last_;
        glideStart_ = time;
    }
    if (gliding_) {
        const double t = std::clamp((time - glideStart_) / kGlideTime, 0.0, 1.0);
        sample.position = glm::mix(glideFrom_, sample.position, t * t * (3.0 - 2.0 * t));
        gliding_ = t < 1.0;
    }
    if (sample.valid) {
        last_ = sample.position;
        started_ = true;
    }
    return sample;
}

} // namespace touchstone

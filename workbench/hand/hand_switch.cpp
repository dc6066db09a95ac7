#include "workbench/hand/hand_switch.h"

#include <algorithm>

namespace touchstone {

std::string HandSwitch::name() const {
    return device_ != nullptr ? device_->name() : simulated() ? "simulated hand" : "mouse";
}

DeviceLimits HandSwitch::limits() const {
    return device_ != nullptr ? device_->limits() : mouse_.limits();
}

void HandSwitch::hold(std::shared_ptr<LinkedDevice> device) {
    device_ = device;
    held_.offer(std::make_shared<const Held>(Held{std::move(device)}));
}

void HandSwitch::face(const glm::dquat& deviceFromView) {
    if (device_ != nullptr)
        device_->face(deviceFromView);
}

void HandSwitch::apply(const DeviceCommand& command) noexcept {
    if (driven_ != nullptr)
        driven_->apply(command);
    else
        mouse_.apply(followed_ == nullptr && !gliding_ ? command : DeviceCommand{});
}

DeviceSample HandSwitch::sample(double time) noexcept {
    DeviceSample sample = mouse_.sample(time);
    const StrokePath* path = path_.adopt();
    if (!simulated_.load(std::memory_order_relaxed))
        path = nullptr;
    const Held* held = held_.adopt();
    driven_ = held != nullptr ? held->device.get() : nullptr;
    const void* follows = driven_ != nullptr ? static_cast<const void*>(driven_) : path;
    if (follows != followed_) {
        followed_ = follows;
        gliding_ = started_;
        glideFrom_ = last_;
        glideStart_ = time;
    }
    if (driven_ != nullptr) {
        sample = driven_->sample(time);
    } else if (path != nullptr) { // it begins where it begins, once the hand is there
        sample.position = path->position(std::max(0.0, time - glideStart_ - kGlideTime));
        sample.age = 0.0;
        sample.valid = true;
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

#include "workbench/hand/device_multiplexer.h"

#include <algorithm>
#include <utility>

namespace touchstone {

namespace {
constexpr glm::dvec3 kNothing{0.0};
}

std::string DeviceMultiplexer::name() const {
    return device_ != nullptr ? device_->name() : simulated() ? "simulated hand" : "mouse";
}

DeviceLimits DeviceMultiplexer::limits() const {
    if (driven_ != nullptr)
        return driven_->limits();
    // A path, and a glide, press as deep as they lead.
    return followed_ == nullptr && !gliding_ ? mouse_.limits() : DeviceLimits{};
}

void DeviceMultiplexer::hold(std::shared_ptr<LinkedDevice> device) {
    if (device_ != device) {
        if (device_ != nullptr)
            device_->letGo();
        if (device != nullptr)
            device->takeUp();
    }
    device_ = device;
    held_.offer(std::make_shared<const Held>(Held{std::move(device)}));
}

void DeviceMultiplexer::face(const glm::dquat& deviceFromView) {
    if (device_ != nullptr)
        device_->face(deviceFromView);
}

void DeviceMultiplexer::apply(const DeviceCommand& command) noexcept {
    if (driven_ != nullptr) {
        away_ = away_ && (gliding_ || command.force() != kNothing || command.torque() != kNothing);
        driven_->apply(away_ ? DeviceCommand{} : command);
    }
}

/// The mouse does not receive what another hand, or a gliding one, feels.
void DeviceMultiplexer::feel(const TouchFeedback& felt) noexcept {
    animation_ = felt.animation;
    if (followed_ == nullptr && !gliding_)
        mouse_.feel(felt);
    else
        mouse_.feel({.objects = felt.objects});
}

/// During a glide the device is elsewhere, and the remaining force of the previous hand does not belong to
/// it: it receives neither. Its force fades in once it is where the hand is.
void DeviceMultiplexer::couple(DeviceSample& sample, double time) noexcept {
    const double dt = std::clamp(time - lastTime_, 0.0, WorkspaceMap::kLongestStep);
    coupling_ = driven_ == nullptr ? 1.0 : away_ ? 0.0 : std::min(1.0, coupling_ + dt / kCouplingTime);
    sample.mapping.coupling *= coupling_;
}

/// Switches to another hand or another path.
void DeviceMultiplexer::follow(const StrokePath* path, double time) noexcept {
    const void* follows = driven_ != nullptr ? static_cast<const void*>(driven_) : path;
    const uint32_t left = leaves_.load(std::memory_order_acquire);
    const bool again = left != left_ && path != nullptr;
    left_ = left;
    if (follows == followed_ && !again)
        return;
    followed_ = follows;
    begins_ = true;
    gliding_ = started_;
    away_ = started_ && driven_ != nullptr;
    glideStart_ = time;
    centre_ = path != nullptr ? path->place() : glm::dvec3(0.0);
    const Similarity before = map_.mapping().workspaceFromDevice;
    map_.begin(followed_ != nullptr ? target() : WorkspaceWish{}, centre_);
    centred_ = centres_.load(std::memory_order_relaxed); // starts there
    const Similarity& now = map_.mapping().workspaceFromDevice;
    // The HIP starts from its last position. In the new hand's frame that is another position without a
    // displacement between them: the tick has no history.
    changed_ = !sameFrame(before, now);
    if (started_)
        glideFrom_ = now.inversePoint(lastHip_);
}

/// Touch starts at the hand's new position: a device that is taken up may be inside the model, where the
/// glide has pulled the proxy. During the glide touch does not restart.
void DeviceMultiplexer::begin(DeviceSample& sample) noexcept {
    if (followed_ != nullptr || gliding_)
        sample.begins = false;
    sample.inSight = driven_ == nullptr;
    if (gliding_ || !sample.valid)
        return;
    sample.begins = sample.begins || std::exchange(begins_, false);
}

/// Clutch and zoom.
void DeviceMultiplexer::place(DeviceSample& sample, double time) noexcept {
    WorkspaceWish wished = target();
    wished.clutch = wished.clutch || (driven_ != nullptr && (sample.buttons & kClutchButton) != 0);
    if (const uint32_t asked = centres_.load(std::memory_order_relaxed); asked != centred_) {
        centred_ = asked;
        map_.centre(centre_);
    }
    map_.apply(sample, wished, time - lastTime_);
}

DeviceSample DeviceMultiplexer::sample(double time) noexcept {
    DeviceSample sample = mouse_.sample(time);
    const StrokePath* path = path_.adopt();
    if (!simulated_.load(std::memory_order_relaxed))
        path = nullptr;
    const Held* held = held_.adopt();
    driven_ = held != nullptr ? held->device.get() : nullptr;
    follow(driven_ != nullptr ? nullptr : path, time);
    if (driven_ != nullptr) {
        sample = driven_->sample(time);
    } else if (path != nullptr) { // starts at its first position, once the hand is there
        sample.position = path->positionIn(
            std::max(0.0, time - glideStart_ - kGlideTime) + lead_ * path->period(), animation_);
        sample.age = 0.0;
        sample.valid = true;
    }
    if (gliding_) {
        const double share = (time - glideStart_) / kGlideTime;
        sample.position = glide(glideFrom_, sample.position, share);
        gliding_ = share < 1.0;
    }
    if (std::exchange(changed_, false))
        sample.valid = false;
    begin(sample);
    if (followed_ != nullptr)
        place(sample, time);
    couple(sample, time);
    lastTime_ = time;
    if (sample.valid) {
        lastHip_ = sample.inWorkspace();
        started_ = true;
    }
    return sample;
}

} // namespace touchstone

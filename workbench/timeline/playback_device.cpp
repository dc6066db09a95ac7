#include "workbench/timeline/playback_device.h"

#include "devices/device/workspace_map.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

RecordedPath::RecordedPath(std::vector<Sample> samples, const Options& options)
    : samples_(std::move(samples)), options_(options) {}

double RecordedPath::lap() const noexcept {
    const double once = length() + PlaybackDevice::kGlideTime;
    if (!(options_.period > 0.0))
        return once;
    constexpr double kExact = 1e-9; // of a period: a lap that is a multiple up to rounding is not extended
    return std::max(1.0, std::ceil(once / options_.period - kExact)) * options_.period;
}

void RecordedPath::begin(double earliest) const noexcept {
    double begin = earliest;
    if (options_.period > 0.0) {
        const double wait = std::fmod(options_.phase - earliest, options_.period);
        begin += wait < 0.0 ? wait + options_.period : wait;
    }
    begun_.store(begin, std::memory_order_relaxed);
}

double RecordedPath::secondsAt(double time) const noexcept {
    const double seconds = time - begun();
    return options_.repeats && seconds > 0.0 ? std::fmod(seconds, lap()) : seconds;
}

DeviceSample RecordedPath::at(double time) const noexcept {
    const double seconds = secondsAt(time);
    const auto after = std::upper_bound(samples_.begin(), samples_.end(), seconds,
                                        [](double s, const Sample& sample) { return s < sample.seconds; });
    DeviceSample out;
    const Sample& before = after == samples_.begin() ? samples_.front() : *std::prev(after);
    out.valid = before.valid;
    out.inSight = true;
    out.position = before.position;
    if (after == samples_.end() && options_.repeats)
        out.position = glide(samples_.back().position, samples_.front().position,
                             (seconds - length()) / PlaybackDevice::kGlideTime);
    else if (after != samples_.end() && after != samples_.begin() && after->valid)
        out.position = glm::mix(before.position, after->position,
                                (seconds - before.seconds) / (after->seconds - before.seconds));
    return out;
}

/// The user's hand does not receive what the recorded or gliding hand feels.
void PlaybackDevice::feel(const TouchFeedback& felt) noexcept {
    if (followed_ == nullptr && !gliding_)
        own_.feel(felt);
    else
        own_.feel({.objects = felt.objects, .animation = felt.animation});
}

/// The command is the user's hand's; what the recorded or gliding hand feels is not bounded by its press.
DeviceLimits PlaybackDevice::limits() const {
    DeviceLimits limits = own_.limits();
    if (followed_ != nullptr || gliding_)
        limits.press = DeviceLimits{}.press;
    return limits;
}

DeviceSample PlaybackDevice::sample(double time) noexcept {
    const DeviceSample own = own_.sample(time);
    const RecordedPath* path = path_.adopt();
    const bool goesOver = path != followed_;
    if (goesOver) {
        followed_ = path;
        gliding_ = started_;
        glideFrom_ = last_;
        glideStart_ = time;
        if (path != nullptr)
            path->begin(time + kGlideTime);
    }
    DeviceSample sample = path != nullptr ? path->at(time) : own;
    if (gliding_) {
        // In the workspace: the live hand may have it clutched and zoomed.
        const glm::dvec3 hip = glide(glideFrom_, sample.inWorkspace(), (time - glideStart_) / kGlideTime);
        sample.position = sample.mapping.workspaceFromDevice.inversePoint(hip);
        gliding_ = time - glideStart_ < kGlideTime;
        // The live hand may be anywhere by now, also inside the model: touch starts where it is.
        sample.begins = path == nullptr && !gliding_;
    }
    const Similarity& now = sample.mapping.workspaceFromDevice;
    if (goesOver && started_ && !sameFrame(now, lastMap_))
        sample.valid = false;
    lastMap_ = now;
    const double dt = std::clamp(time - lastTime_, 0.0, WorkspaceMap::kLongestStep);
    lastTime_ = time;
    coupling_ = path != nullptr || gliding_ ? 0.0 : std::min(1.0, coupling_ + dt / kCouplingTime);
    sample.mapping.coupling *= coupling_;
    if (sample.valid) {
        last_ = sample.inWorkspace();
        started_ = true;
    }
    return sample;
}

} // namespace touchstone

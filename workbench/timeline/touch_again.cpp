#include "workbench/timeline/touch_again.h"

#include "engine/core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace touchstone {

namespace {

constexpr double kAfterwards = 0.2; // s that the hand rests at the end of the recording

using PathPtr = std::shared_ptr<const RecordedPath>;

bool usable(const DeviceSample& sample) {
    return sample.valid && std::isfinite(sample.position.x) && std::isfinite(sample.position.y) &&
           std::isfinite(sample.position.z);
}

/// The hand's positions in the ticks of the part.
PathPtr readPath(const Timeline& timeline, const TouchAgain::Part& part, JobProgress& progress) {
    RecordingReader reader(timeline.file());
    const TimelineSegment& segment = timeline.segments()[timeline.segmentOf(part.first)];
    reader.goTo(segment.offset);
    std::vector<RecordedPath::Sample> samples;
    samples.reserve(part.last - part.first + 1);
    double phase = 0.0;
    for (size_t index = segment.first; index <= part.last;) {
        const std::optional<RecordingReader::Item> item = reader.next();
        if (!item)
            throw Error(timeline.file().string(), "tick " + std::to_string(index),
                        "is no longer what it was when it was opened", "open it again");
        const auto* block = std::get_if<RecordedTicks>(&item->item);
        if (block == nullptr)
            continue;
        progress.at(static_cast<double>(samples.size()) / static_cast<double>(part.last - part.first + 1));
        for (const RecordedTick& tick : block->ticks) {
            if (index >= part.first && index <= part.last)
                samples.push_back({.seconds = timeline.seconds(index) - timeline.seconds(part.first),
                                   .position = part.deviceFromRecorded.point(tick.sample.inWorkspace()),
                                   .valid = usable(tick.sample)});
            if (index == part.first)
                phase = tick.time;
            ++index;
        }
    }
    return std::make_shared<RecordedPath>(
        std::move(samples),
        RecordedPath::Options{.repeats = part.repeats, .period = part.period, .phase = phase});
}

} // namespace

void TouchAgain::start(std::shared_ptr<const Timeline> timeline, const Part& part) {
    stop();
    clear();
    timeline_ = std::move(timeline);
    part_ = part;
    force_.assign(part.last - part.first + 1, std::numeric_limits<float>::quiet_NaN());
    startWanted_ = true;
}

void TouchAgain::stop() {
    reading_.abandon();
    startWanted_ = false;
    seconds_.reset();
    if (path_ != nullptr)
        hand_.follow(nullptr);
    path_.reset();
}

void TouchAgain::clear() {
    force_.clear();
    lastFelt_.reset();
    recordedSum_ = nowSum_ = 0.0;
    compared_ = 0;
}

void TouchAgain::update(const ForceHistory& live, double servoTime) {
    hand_.collect();
    if (std::optional<PathPtr> path = reading_.take()) {
        path_ = std::move(*path);
        seen_ = servoTime;
        hand_.follow(path_);
    }
    if (startWanted_ && !reading_.busy()) {
        startWanted_ = false;
        reading_.start([timeline = timeline_, part = part_](JobProgress& progress) {
            return readPath(*timeline, part, progress);
        });
    }
    if (path_ == nullptr)
        return;
    size_t fresh = live.size();
    while (fresh > 0 && live.at(fresh - 1).time > seen_)
        --fresh;
    for (; fresh < live.size(); ++fresh) {
        const ForceHistory::Entry& entry = live.at(fresh);
        seen_ = entry.time;
        feel(path_->secondsAt(entry.time), entry.force);
    }
    const double seconds = path_->secondsAt(servoTime);
    seconds_.reset();
    if (seconds >= 0.0)
        seconds_ = timeline_->seconds(part_.first) + std::min(seconds, path_->length());
    if (!path_->repeats() && seconds > path_->length() + kAfterwards)
        stop();
}

void TouchAgain::feel(double seconds, float force) {
    if (!(seconds >= 0.0) || seconds > path_->length())
        return;
    const size_t index =
        std::clamp(timeline_->indexAt(timeline_->seconds(part_.first) + seconds), part_.first, part_.last);
    const size_t at = index - part_.first;
    if (lastFelt_ && at < *lastFelt_) { // next round
        recordedSum_ = nowSum_ = 0.0;
        compared_ = 0;
    }
    // The servo's deadlines lie between the recorded ones: occasionally one is skipped.
    constexpr size_t kPassedOver = 8;
    const size_t from = lastFelt_ && at > *lastFelt_ && at - *lastFelt_ < kPassedOver ? *lastFelt_ + 1 : at;
    for (size_t i = from; i <= at; ++i)
        force_[i] = force;
    lastFelt_ = at;
    const float recorded = timeline_->force()[index];
    if (recorded <= 0.0f && force <= 0.0f)
        return;
    recordedSum_ += static_cast<double>(recorded);
    nowSum_ += static_cast<double>(force);
    ++compared_;
}

TouchAgain::Means TouchAgain::means() const {
    if (compared_ == 0)
        return {};
    const auto count = static_cast<double>(compared_);
    return {.recorded = recordedSum_ / count, .now = nowSum_ / count, .ticks = compared_};
}

} // namespace touchstone

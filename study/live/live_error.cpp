#include "study/live/live_error.h"

#include "engine/core/float_mode.h"
#include "haptics/servo/realtime_thread.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace touchstone::study {

namespace {

/// Nearest rank; sorts `values`.
LiveErrorFigures::Pair pairOf(std::vector<double>& values) {
    if (values.empty())
        return {};
    std::ranges::sort(values);
    const auto at = [&](double share) {
        const auto rank = static_cast<size_t>(std::ceil(share * static_cast<double>(values.size())));
        return values[std::max<size_t>(rank, 1) - 1];
    };
    return {at(0.5), at(0.99)};
}

} // namespace

LiveError::LiveError(double rateHz, double seconds, size_t capacity)
    : capacity_(capacity), window_(static_cast<size_t>(std::max(1.0, rateHz * seconds))), stepNs_(window_),
      thread_([this] { work(); }) {}

LiveError::~LiveError() {
    {
        const std::scoped_lock lock(mutex_);
        stopping_ = true;
    }
    wake_.notify_one();
    thread_.join();
}

void LiveError::sceneOffered(uint32_t number, std::shared_ptr<const HapticScene> scene, ScenePtr source) {
    const std::scoped_lock lock(mutex_);
    scenes_.push_back({number, std::move(scene), std::move(source)});
}

void LiveError::take(const TickRecord& record, const HapticSettings& settings) {
    batch_.push_back({record, settings});
}

void LiveError::flush() {
    if (batch_.empty())
        return;
    {
        const std::scoped_lock lock(mutex_);
        const size_t room = capacity_ - std::min(capacity_, waiting_.size());
        const size_t taken = std::min(room, batch_.size());
        waiting_.insert(waiting_.end(), batch_.begin(), batch_.begin() + static_cast<std::ptrdiff_t>(taken));
        dropped_ += batch_.size() - taken;
    }
    batch_.clear();
    wake_.notify_one();
}

LiveErrorFigures LiveError::figures() const {
    const std::scoped_lock lock(mutex_);
    LiveErrorFigures now = figures_;
    now.dropped = dropped_;
    return now;
}

void LiveError::drain() {
    flush();
    std::unique_lock lock(mutex_);
    idle_.wait(lock, [this] { return waiting_.empty() && !busy_; });
}

void LiveError::work() {
    enterFloatMode(); // as the servo: the same bits
    constexpr int kYielding = 10;
    setpriority(PRIO_PROCESS, 0, kYielding); // this thread only: servo and window have priority
    std::vector<Tick> batch;
    std::unique_lock lock(mutex_);
    for (;;) {
        wake_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
        if (stopping_)
            return;
        batch.swap(waiting_);
        busy_ = true;
        lock.unlock();
        compareBatch(batch);
        batch.clear();
        summarise();
        lock.lock();
        busy_ = false;
        idle_.notify_all();
    }
}

void LiveError::enterScene(uint32_t number) {
    scene_ = number;
    OfferedScene entered;
    {
        const std::scoped_lock lock(mutex_);
        while (!scenes_.empty() && scenes_.front().number < number)
            scenes_.pop_front();
        if (!scenes_.empty() && scenes_.front().number == number)
            entered = scenes_.front();
    }
    reference_.enter(std::move(entered.scene), std::move(entered.source));
}

void LiveError::compareBatch(const std::vector<Tick>& batch) {
    for (const Tick& tick : batch) {
        const TickRecord& record = tick.record;
        if (record.scene != scene_)
            enterScene(record.scene);
        if (begun_ && record.step > nextStep_)
            for (uint64_t i = 0; i < std::min<uint64_t>(record.step - nextStep_, window_); ++i)
                add({});
        begun_ = true;
        nextStep_ = record.step + 1;
        Entry entry;
        const long long begin = monotonicNs();
        entry.compared = reference_.compare(record, tick.settings, entry.error);
        if (entry.compared) {
            stepNs_.add(monotonicNs() - begin);
            ++compared_;
        }
        if (record.scene != 0)
            add(entry);
    }
}

void LiveError::add(const Entry& entry) {
    entries_.push_back(entry);
    if (entries_.size() > window_)
        entries_.pop_front();
}

void LiveError::summarise() {
    LiveErrorFigures now;
    std::vector<double> position, force, share, direction;
    size_t compared = 0;
    for (const Entry& entry : entries_) {
        compared += entry.compared ? 1 : 0;
        now.lost += entry.error.contact == TickError::Contact::Lost ? 1 : 0;
        now.invented += entry.error.contact == TickError::Contact::Invented ? 1 : 0;
        if (entry.error.contact != TickError::Contact::Both)
            continue;
        position.push_back(entry.error.position);
        force.push_back(entry.error.force);
        share.push_back(entry.error.forceShare);
        direction.push_back(entry.error.direction);
    }
    now.inContact = position.size();
    now.position = pairOf(position);
    now.force = pairOf(force);
    now.forceShare = pairOf(share);
    now.direction = pairOf(direction);
    now.comparedShare =
        entries_.empty() ? 0.0 : static_cast<double>(compared) / static_cast<double>(entries_.size());
    now.stepNs = stepNs_.mean();
    now.compared = compared_;
    const std::scoped_lock lock(mutex_);
    figures_ = now;
}

} // namespace touchstone::study

#include "api/c/offline_hand.h"

#include "api/c/calls.h"
#include "engine/core/float_mode.h"
#include "engine/core/realtime_guard.h"
#include "haptics/servo/realtime_thread.h"

#include <cmath>

namespace touchstone::api {

namespace {

constexpr size_t kBlock = 4096; // ticks between two questions whether to go on

/// The float mode of a tick, for as long as this lives: the caller's own code keeps his.
class TickFloatMode {
  public:
    TickFloatMode() : before_(_mm_getcsr()) { enterFloatMode(); }
    ~TickFloatMode() { _mm_setcsr(before_); }
    TickFloatMode(const TickFloatMode&) = delete;
    TickFloatMode& operator=(const TickFloatMode&) = delete;

  private:
    unsigned before_;
};

bool stops(const ts_path& path, size_t done) {
    return path.progress != nullptr && path.progress(path.context, done, path.count) != 0;
}

} // namespace

OfflineHand::OfflineHand(std::shared_ptr<TouchedScene> scene, const HapticSettings& settings)
    : scene_(std::move(scene)), settings_(settings), hand_(*scene_->haptic(), scene_->source()) {
    scene_->prepareFor(settings_);
}

void OfflineHand::set(std::string_view name, std::string_view value) {
    const std::lock_guard lock(mutex_);
    if (const std::string problem = setSetting(settings_, name, value); !problem.empty())
        refuseArgument("value", problem);
    scene_->prepareFor(settings_);
}

OfflineHand::Moment OfflineHand::moment(const ts_path& path, size_t i) const noexcept {
    if (path.times == nullptr) {
        // As a path whose times are n / rate: a tick lasts from row to row.
        const size_t n = number_ + i;
        const double time = base_ + static_cast<double>(n) / rate_;
        return {time, n > 0 ? time - (base_ + static_cast<double>(n - 1) / rate_) : 1.0 / rate_};
    }
    const double time = path.times[i];
    if (i > 0)
        return {time, time - path.times[i - 1]};
    if (begun_)
        return {time, time - last_};
    return {time, path.count > 1 ? path.times[1] - time : 1e-3};
}

void OfflineHand::check(const ts_path& path) const {
    if (path.positions == nullptr)
        refuseArgument("path.positions", "is null");
    if (path.times == nullptr && path.rate != 0.0 && !(path.rate >= 1.0 && path.rate <= 1e6))
        refuseArgument("path.rate", "is not within 1 .. 1e6 Hz");
    double before = begun_ ? last_ : -INFINITY;
    for (size_t i = 0; i < path.count; ++i) {
        for (size_t axis = 0; axis < 3; ++axis)
            if (!std::isfinite(path.positions[3 * i + axis])) [[unlikely]]
                refuseArgument("path.positions[" + std::to_string(i) + "]", "is not finite");
        if (path.times == nullptr)
            continue;
        if (!std::isfinite(path.times[i]) || !(path.times[i] > before)) [[unlikely]]
            refuseArgument("path.times[" + std::to_string(i) + "]",
                           std::isfinite(path.times[i]) ? "the time does not increase" : "is not finite");
        before = path.times[i];
    }
}

size_t OfflineHand::touch(const ts_path& path, const TickArrays& ticks) {
    const std::lock_guard lock(mutex_);
    if (path.count == 0)
        return 0;
    check(path);
    if (path.times == nullptr) {
        const double rate = path.rate != 0.0 ? path.rate : 1000.0;
        if (rate != rate_) {
            base_ = begun_ ? last_ + 1.0 / rate : 0.0;
            rate_ = rate;
            number_ = 0;
        }
    }
    size_t done = 0;
    while (done < path.count && !stops(path, done)) {
        const TickFloatMode mode;
        const size_t end = std::min(path.count, done + kBlock);
        for (; done < end; ++done) {
            const double* at = path.positions + 3 * done;
            const Moment now = moment(path, done);
            hand_.advance(now.time, settings_);
            StageTrace trace;
            StageTracer tracer(hand_.state, trace);
            const int64_t begin = ticks.timed() ? monotonicNs() : 0;
            {
                const realtime::TickScope scope;
                (void)hand_.step(settings_, sampleAt({at[0], at[1], at[2]}), now.dt, tracer);
            }
            ticks.put(done, rowOf(now.time, hand_.output, ticks.timed() ? monotonicNs() - begin : 0));
        }
    }
    if (done > 0) {
        last_ = moment(path, done - 1).time;
        begun_ = true;
        if (path.times == nullptr)
            number_ += done;
        else
            rate_ = 0.0;
    }
    return done;
}

} // namespace touchstone::api

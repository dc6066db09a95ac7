#include "api/c/offline_hand.h"

#include "api/c/calls.h"
#include "engine/core/float_mode.h"
#include "engine/core/realtime_guard.h"
#include "haptics/servo/realtime_thread.h"
#include "haptics/tick/stepped_hand.h"

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

size_t checkedHands(size_t hands) {
    if (hands < 1 || hands > kMaxHands)
        refuseArgument("count", "is not within 1 .. " + std::to_string(kMaxHands));
    return hands;
}

OfflineHand::OfflineHand(std::shared_ptr<TouchedScene> scene, const HapticSettings& settings, size_t hands)
    : scene_(std::move(scene)), settings_(settings),
      hands_(*scene_->haptic(), scene_->source(), checkedHands(hands)), traces_(hands) {
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

void OfflineHand::check(const ts_path& path, const std::string& name) const {
    if (path.positions == nullptr)
        refuseArgument(name + ".positions", "is null");
    if (path.times == nullptr && path.rate != 0.0 && !(path.rate >= 1.0 && path.rate <= 1e6))
        refuseArgument(name + ".rate", "is not within 1 .. 1e6 Hz");
    double before = begun_ ? last_ : -INFINITY;
    for (size_t i = 0; i < path.count; ++i) {
        for (size_t axis = 0; axis < 3; ++axis)
            if (!std::isfinite(path.positions[3 * i + axis])) [[unlikely]]
                refuseArgument(name + ".positions[" + std::to_string(i) + "]", "is not finite");
        if (path.times == nullptr)
            continue;
        if (!std::isfinite(path.times[i]) || !(path.times[i] > before)) [[unlikely]]
            refuseArgument(name + ".times[" + std::to_string(i) + "]",
                           std::isfinite(path.times[i]) ? "the time does not increase" : "is not finite");
        before = path.times[i];
    }
}

void OfflineHand::check(std::span<const ts_path> paths) const {
    const size_t hands = hands_.states.size();
    if (paths.size() != hands)
        refuseArgument("count", std::to_string(paths.size()) + " paths of " + std::to_string(hands) +
                                    (hands == 1 ? " hand" : " hands; ts_hands_touch takes them"));
    if (hands == 1)
        return check(paths.front(), "path");
    for (size_t hand = 0; hand < hands; ++hand) {
        const std::string name = "paths[" + std::to_string(hand) + "]";
        if (paths[hand].count != paths.front().count)
            refuseArgument(name + ".count", "differs from that of the first");
        if (hand > 0 && paths[hand].times != nullptr)
            refuseArgument(name + ".times", "is not null: the times are those of the first");
        check(paths[hand], name);
    }
}

size_t OfflineHand::touch(std::span<const ts_path> paths, std::span<const TickArrays> ticks) {
    const std::lock_guard lock(mutex_);
    if (paths.size() == hands_.states.size() && paths.front().count == 0)
        return 0;
    check(paths);
    const ts_path& path = paths.front();
    if (path.times == nullptr) {
        const double rate = path.rate != 0.0 ? path.rate : 1000.0;
        if (rate != rate_) {
            base_ = begun_ ? last_ + 1.0 / rate : 0.0;
            rate_ = rate;
            number_ = 0;
        }
    }
    bool timed = false;
    for (const TickArrays& arrays : ticks)
        timed = timed || arrays.timed();
    size_t done = 0;
    while (done < path.count && !stops(path, done)) {
        const TickFloatMode mode;
        const size_t end = std::min(path.count, done + kBlock);
        for (; done < end; ++done) {
            const Moment now = moment(path, done);
            const int64_t took = tick(paths, done, now.time, now.dt, timed);
            for (size_t hand = 0; hand < ticks.size(); ++hand)
                ticks[hand].put(done, rowOf(now.time, hands_.outputs[hand], took));
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

/// Row `i` of the paths. Returns the ns that it took, 0 where it is not `timed`.
int64_t OfflineHand::tick(std::span<const ts_path> paths, size_t i, double time, double dt,
                          bool timed) noexcept {
    for (size_t hand = 0; hand < paths.size(); ++hand) {
        const double* at = paths[hand].positions + 3 * i;
        hands_.samples[hand] = sampleAt({at[0], at[1], at[2]});
    }
    hands_.advance(time, settings_);
    StageTracer tracer(hands_.states, traces_);
    const realtime::TickScope scope; // outside the clock, as in `touchstone touch`
    const int64_t begin = timed ? monotonicNs() : 0;
    hands_.step(settings_, dt, tracer);
    return timed ? monotonicNs() - begin : 0;
}

} // namespace touchstone::api

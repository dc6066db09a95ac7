#pragma once
// What the early stages left behind: so that a recording can name the stage in which a replay first differs.

#include "haptics/state/device_state.h"
#include "haptics/tick/stopwatch.h"

#include <glm/glm.hpp>

#include <array>

namespace touchstone {

/// HapticOutput tells where the proxy ended; this tells how it came there. Zero where a stage was not
/// reached.
struct StageTrace {
    /// After contact query (carried by its object, placed), proxy solve and force shading: frame of the
    /// reference object, object units.
    std::array<glm::dvec3, 3> proxy{};
    int reference = -1; ///< HapticScene::objects
};

/// What the servo, `touch` and a replay pass as Stopwatch. One instantiation for all three, since the
/// compiler may round differently in another one (fused multiply-adds): whether it also takes the time is
/// asked as it goes, and changes no bit of what is felt. For one device.
class StageTracer {
  public:
    /// `clock`: takes the time of each stage; null: nobody reads a clock.
    StageTracer(const DeviceState& state, StageTrace& trace, StageStopwatch* clock = nullptr) noexcept
        : state_(state), trace_(trace), clock_(clock) {}

    void start() noexcept {
        trace_ = StageTrace{};
        if (clock_ != nullptr) [[unlikely]]
            startClock();
    }
    void lap(Stage stage) noexcept {
        if (clock_ != nullptr) [[unlikely]]
            readClock(stage);
        if (stage == Stage::Contact)
            trace_.reference = state_.reference;
        if (stage == Stage::Contact || stage == Stage::Proxy || stage == Stage::Shading)
            trace_.proxy[static_cast<size_t>(stage) - static_cast<size_t>(Stage::Contact)] = state_.proxy;
    }

  private:
    // Out of line: the step keeps its registers.
    [[gnu::noinline]] void startClock() noexcept { clock_->start(); }
    [[gnu::noinline]] void readClock(Stage stage) noexcept { clock_->lap(stage); }

    const DeviceState& state_;
    StageTrace& trace_;
    StageStopwatch* clock_;
};

} // namespace touchstone

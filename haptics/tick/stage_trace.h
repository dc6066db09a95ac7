#pragma once
// Intermediate results of the early stages, so that a replay can name the first stage that differs.

#include "haptics/state/device_state.h"
#include "haptics/tick/stopwatch.h"

#include <glm/glm.hpp>

#include <array>
#include <span>

namespace touchstone {

/// HapticOutput reports the final proxy; this reports the proxy after each stage. Zero where a stage was not
/// reached.
struct StageTrace {
    /// After contact query (carried by its object, placed), proxy solve and force shading: frame of the
    /// reference object, object units.
    std::array<glm::dvec3, 3> proxy{};
    int reference = -1; ///< HapticScene::objects
};

/// The Stopwatch of the servo, `touch` and the replay: all three use one instantiation, and so run the same
/// code. Whether it reads a clock is decided at run time and changes no bit of the result.
class StageTracer {
  public:
    /// One state and one trace per hand. `clock`: measures each stage; null: no clock is read.
    StageTracer(std::span<const DeviceState> states, std::span<StageTrace> traces,
                StageStopwatch* clock = nullptr) noexcept
        : states_(states.data()), traces_(traces.data()), state_(states_), trace_(traces_), clock_(clock) {}
    StageTracer(const DeviceState& state, StageTrace& trace, StageStopwatch* clock = nullptr) noexcept
        : StageTracer({&state, 1}, {&trace, 1}, clock) {}

    void start() noexcept {
        if (clock_ != nullptr) [[unlikely]]
            startClock();
    }
    /// The laps that follow are those of hand `i`.
    void hand(size_t i) noexcept {
        state_ = states_ + i;
        trace_ = traces_ + i;
    }
    void lap(Stage stage) noexcept {
        if (clock_ != nullptr) [[unlikely]]
            readClock(stage);
        if (stage == Stage::Sample)
            *trace_ = StageTrace{};
        if (stage == Stage::Contact)
            trace_->reference = state_->reference;
        if (stage == Stage::Contact || stage == Stage::Proxy || stage == Stage::Shading)
            trace_->proxy[static_cast<size_t>(stage) - static_cast<size_t>(Stage::Contact)] = state_->proxy;
    }

  private:
    // Out of line, so that the step keeps its registers.
    [[gnu::noinline]] void startClock() noexcept { clock_->start(); }
    [[gnu::noinline]] void readClock(Stage stage) noexcept { clock_->lap(stage); }

    const DeviceState* states_;
    StageTrace* traces_;
    const DeviceState* state_;
    StageTrace* trace_;
    StageStopwatch* clock_;
};

} // namespace touchstone

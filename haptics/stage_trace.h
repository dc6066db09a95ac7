#pragma once
// What the early stages left behind: so that a recording can name the stage in which a replay first differs.

#include "haptics/device_state.h"
#include "haptics/stopwatch.h"

#include <glm/glm.hpp>

#include <array>

namespace touchstone {

/// HapticOutput tells where the proxy ended; this tells how it came there. Zero where a stage was not
/// reached.
struct StageTrace {
    /// After contact query (carried by its object, placed), proxy solve and force shading: frame of the
    /// anchor, object units.
    std::array<glm::dvec3, 3> proxy{};
    int anchor = -1; ///< HapticScene::objects
};

/// A Stopwatch that takes no time: what the servo, `touch` and a replay pass. One instantiation for all
/// three, since the compiler may round differently in another one (fused multiply-adds). For one device.
class StageTracer {
  public:
    StageTracer(const DeviceState& state, StageTrace& trace) noexcept : state_(state), trace_(trace) {}

    void start() noexcept { trace_ = StageTrace{}; }
    void lap(Stage stage) noexcept {
        if (stage == Stage::Contact)
            trace_.anchor = state_.anchor;
        if (stage == Stage::Contact || stage == Stage::Proxy || stage == Stage::Shading)
            trace_.proxy[static_cast<size_t>(stage) - static_cast<size_t>(Stage::Contact)] = state_.proxy;
    }

  private:
    const DeviceState& state_;
    StageTrace& trace_;
};

} // namespace touchstone

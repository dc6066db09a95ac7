#pragma once
// Tests one device: its samples, their rate and age, and optionally its force.

#include "devices/link/linked_device.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace touchstone {

struct DeviceTestFigures {
    double seconds = 0.0;
    uint64_t ticks = 0, validTicks = 0, staleTicks = 0;
    std::vector<double> ages;                  ///< s, of every valid tick, sorted
    glm::dvec3 low{0.0}, high{0.0}, last{0.0}; ///< m, of the valid ticks
    uint32_t buttonsSeen = 0;
    double ordered = 0.0; ///< N, maximum commanded force
    LinkReport report;
};

/// Samples the device a thousand times a second for `seconds`, or until interrupted. With `force` > 0 (N) it
/// pushes the hand along each axis in turn, through the limiter of the safety stage. Owner thread.
[[nodiscard]] DeviceTestFigures testDevice(LinkedDevice& device, double seconds, double force);

[[nodiscard]] std::string describe(const DeviceTestFigures& figures, const LinkedDevice& device);
[[nodiscard]] nlohmann::ordered_json toJson(const DeviceTestFigures& figures, const LinkedDevice& device);

/// A link's counters, for the figures of `devices --test` and `run --device`.
[[nodiscard]] nlohmann::ordered_json linkJson(const LinkReport& report);

/// "searching", "refused", "connected"
[[nodiscard]] const char* stateName(LinkState state);

} // namespace touchstone

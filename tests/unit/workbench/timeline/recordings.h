#pragma once
// Recordings as a test wants them, and the timeline of a file.

#include "haptics/recording/recording_format.h"
#include "tests/support/program.h"
#include "tests/support/recorded_servo.h"
#include "workbench/timeline/timeline.h"

#include <memory>

namespace touchstone::test {

/// Ticks of 1 ms from `time` on, with a force of `newton(i)`; in contact where it is above zero.
template <class Newton>
RecordedTicks ticksFrom(double time, size_t count, const Newton& newton, uint32_t settings = 1) {
    RecordedTicks block;
    for (size_t i = 0; i < count; ++i) {
        RecordedTick tick;
        tick.tick = static_cast<uint64_t>(time * 1000.0 + 0.5) + i;
        tick.time = time + 1e-3 * static_cast<double>(i);
        tick.dt = 1e-3;
        tick.settings = settings;
        tick.sample.valid = true;
        tick.force = glm::dvec3(0.0, newton(i), 0.0);
        tick.proxy = glm::dvec3(0.0, 1e-3 * newton(i), 0.0);
        tick.contacts = newton(i) > 0.0 ? 1 : 0;
        block.ticks.push_back(tick);
    }
    return block;
}

inline std::shared_ptr<const Timeline> timelineOf(const std::filesystem::path& file) {
    JobProgress progress;
    return std::make_shared<const Timeline>(Timeline::load(file, progress));
}

} // namespace touchstone::test

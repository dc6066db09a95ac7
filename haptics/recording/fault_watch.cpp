#include "haptics/recording/fault_watch.h"

#include "haptics/settings/tick_flags.h"

#include <algorithm>
#include <utility>

namespace touchstone {

std::optional<Fault> FaultWatch::add(const RecordedTick& tick) {
    constexpr double kMemory = 1.0; // s
    constexpr double kForget = 0.1; // s of invalid input that a second of valid input offsets
    const bool faulty = has(tick.flags, TickFlag::ForceFault);
    const bool latched = has(tick.flags, TickFlag::SafetyLatched);
    // A hand in sight has been lifted on purpose, or its image stalls: no device has failed.
    const bool invalid = has(tick.flags, TickFlag::InputInvalid) && !tick.sample.inSight;
    sinceContact_ = tick.contacts > 0 ? 0.0 : sinceContact_ + tick.dt;
    invalid_ = invalid ? invalid_ + tick.dt : std::max(0.0, invalid_ - kForget * tick.dt);
    valid_ = invalid ? 0.0 : valid_ + tick.dt;
    if (valid_ > kMemory) {
        lost_ = false;
        invalid_ = 0.0;
    }
    const bool beganFault = faulty && !std::exchange(faulty_, faulty);
    const bool beganLatch = latched && !std::exchange(latched_, latched);
    faulty_ = faulty;
    latched_ = latched;
    if (beganFault)
        return Fault{"force-fault", "the force was not a finite number: it was cut to zero and stays off"};
    if (beganLatch)
        return Fault{"safety-latched", "too many late ticks in a row: the force faded out and stays off"};
    if (!invalid || invalid_ < kInputLost || sinceContact_ > kMemory || std::exchange(lost_, true))
        return std::nullopt;
    return Fault{"input-lost", "the device gave no usable samples while it touched: the force faded out"};
}

} // namespace touchstone

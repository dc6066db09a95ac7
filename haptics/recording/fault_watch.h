#pragma once
// When the last seconds are worth keeping.

#include "haptics/recording/recording_format.h"

#include <optional>
#include <string>

namespace touchstone {

struct Fault {
    std::string name; ///< for a file: "force-fault"
    std::string text; ///< for a person
};

/// Looks at every tick in order. One thread.
class FaultWatch {
  public:
    /// s of a second without a usable sample, after which a hand that was pushed a second ago counts as lost.
    static constexpr double kInputLost = 0.1;

    /// What begins with this tick: a force that is not finite, a safety latch, a hand lost while it touched.
    /// Each is told when it begins, not as long as it lasts.
    [[nodiscard]] std::optional<Fault> add(const RecordedTick& tick);

  private:
    bool faulty_ = false, latched_ = false, lost_ = false;
    double invalid_ = 0.0, valid_ = 0.0, sinceContact_ = 1e9; // s
};

} // namespace touchstone

#pragma once
// Detects when the last seconds are worth keeping.

#include "haptics/recording/recording_format.h"

#include <optional>
#include <string>

namespace touchstone {

struct Fault {
    std::string name; ///< for a file: "force-fault"
    std::string text; ///< for a person
};

/// Examines every tick in order. One thread.
class FaultWatch {
  public:
    /// s: accumulated time without a usable sample after which the hand counts as lost, if it was in contact
    /// within the last second.
    static constexpr double kInputLost = 0.1;

    /// A fault that begins with this tick: a force that is not finite, a safety latch, a hand lost during
    /// contact. Each is reported once, when it begins.
    [[nodiscard]] std::optional<Fault> add(const RecordedTick& tick);

  private:
    bool faulty_ = false, latched_ = false, lost_ = false;
    double invalid_ = 0.0, valid_ = 0.0, sinceContact_ = 1e9; // s
};

} // namespace touchstone

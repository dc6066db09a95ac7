#pragma once

#include "haptics/haptic_step.h"

#include <cstddef>
#include <vector>

namespace touchstone {

/// The newest ticks' forces, for the plot and the status: magnitude, and the part along the felt surface.
/// Main thread.
class ForceHistory {
  public:
    /// `ticks` are kept.
    explicit ForceHistory(size_t ticks) : entries_(ticks) {}

    struct Entry {
        float force = 0.0f;      ///< N, magnitude of stage 7
        float tangential = 0.0f; ///< N, magnitude of its part perpendicular to the felt normal
        bool contact = false;
    };
    void add(const HapticOutput& output);
    void clear() { count_ = 0; }

    [[nodiscard]] size_t size() const { return count_; }
    /// i = 0 is the oldest that is kept.
    [[nodiscard]] const Entry& at(size_t i) const {
        return entries_[(next_ + entries_.size() - count_ + i) % entries_.size()];
    }
    /// Means over the newest `ticks` that were in contact; zero where none was.
    [[nodiscard]] Entry mean(size_t ticks) const;

  private:
    std::vector<Entry> entries_;
    size_t next_ = 0, count_ = 0;
};

} // namespace touchstone

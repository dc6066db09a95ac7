#pragma once

#include "haptics/servo/servo_loop.h"

#include <cstddef>
#include <vector>

namespace touchstone {

/// The newest ticks, for the charts and the status. Main thread.
class ForceHistory {
  public:
    /// `ticks` are kept.
    explicit ForceHistory(size_t ticks) : entries_(ticks) {}

    struct Entry {
        double time = 0.0;        ///< s since the servo started
        float force = 0.0f;       ///< N, magnitude of stage 7
        float tangential = 0.0f;  ///< N, magnitude of its part perpendicular to the felt normal
        float penetration = 0.0f; ///< m
        float energy = 0.0f;      ///< J, passivity observer's balance
        float step = 0.0f;        ///< s, time of the whole step
        bool contact = false;
        bool recorded = false; ///< a recording ran
    };
    void add(const TickRecord& record, bool recorded);
    void clear() { count_ = 0; }

    [[nodiscard]] size_t size() const { return count_; }
    /// i = 0 is the oldest that is kept.
    [[nodiscard]] const Entry& at(size_t i) const {
        return entries_[(next_ + entries_.size() - count_ + i) % entries_.size()];
    }
    /// Means of the forces over the newest `ticks` that were in contact; zero where none was.
    [[nodiscard]] Entry mean(size_t ticks) const;

  private:
    std::vector<Entry> entries_;
    size_t next_ = 0, count_ = 0;
};

} // namespace touchstone

#pragma once

#include "haptics/servo/servo_loop.h"

#include <cstddef>
#include <vector>

namespace touchstone {

/// The latest ticks, for charts and status. Main thread.
class ForceHistory {
  public:
    /// `ticks`: capacity.
    explicit ForceHistory(size_t ticks) : entries_(ticks) {}

    struct Entry {
        double time = 0.0;              ///< s since the servo started
        float force = 0.0f;             ///< N, magnitude of stage 7
        float tangential = 0.0f;        ///< N, magnitude of the component perpendicular to the felt normal
        float normal = 0.0f;            ///< N, along the normal of the mesh (surfaceNormal)
        float surfaceTangential = 0.0f; ///< N, magnitude of the component perpendicular to it
        float x = 0.0f, y = 0.0f, z = 0.0f; ///< N, workspace
        float penetration = 0.0f;           ///< m
        float energy = 0.0f;                ///< J, energy balance of the passivity observer
        float step = 0.0f;                  ///< s, time of the whole step
        bool contact = false;
        bool recorded = false; ///< during a recording
    };
    void add(const TickRecord& record, bool recorded);
    void clear() { count_ = 0; }

    [[nodiscard]] size_t size() const { return count_; }
    /// i = 0 is the oldest.
    [[nodiscard]] const Entry& at(size_t i) const {
        return entries_[(next_ + entries_.size() - count_ + i) % entries_.size()];
    }
    /// Means of the forces over the latest `ticks` in contact; zero where there is none.
    [[nodiscard]] Entry mean(size_t ticks) const;

  private:
    std::vector<Entry> entries_;
    size_t next_ = 0, count_ = 0;
};

} // namespace touchstone

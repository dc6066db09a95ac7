#pragma once

#include "haptics/recording/recording_format.h"
#include "haptics/tick/haptic_step.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>

namespace touchstone {

/// A recorded touch beside what other settings make of the same path of the hand. Forces are those of stage
/// 7, in the workspace. Means are over the ticks that are in contact with either. One thread.
class ForceComparison {
  public:
    /// `seconds`: place in the recording. `now`: the same tick with the other settings.
    void add(double seconds, const RecordedTick& recorded, const HapticOutput& now);

    struct Side {
        uint64_t contactTicks = 0;
        double mean = 0.0, max = 0.0; ///< N
    };
    [[nodiscard]] Side recorded() const {
        return {recorded_.contactTicks, mean(recorded_.sum), recorded_.max};
    }
    [[nodiscard]] Side other() const { return {other_.contactTicks, mean(other_.sum), other_.max}; }
    [[nodiscard]] uint64_t ticks() const { return ticks_; } ///< in contact with either
    /// The length of the difference of both forces, N: what a direction that turns counts for, too.
    [[nodiscard]] double meanDifference() const { return mean(differenceSum_); }
    [[nodiscard]] double maxDifference() const { return maxDifference_; }
    [[nodiscard]] double maxDifferenceAt() const { return maxDifferenceAt_; } ///< s, in the recording
    [[nodiscard]] double maxProxyDistance() const {
        return maxProxyDistance_;
    } ///< m, where both are in contact

    /// "then 0.612 N, now 0.598 N on average in contact; at most 0.31 N apart, at 2.418 s", or why there is
    /// nothing to compare. `now`: what the other settings are called.
    [[nodiscard]] std::string text(const std::string& now) const;
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    struct Sums {
        uint64_t contactTicks = 0;
        double sum = 0.0, max = 0.0;
        void add(double force, bool contact);
    };
    [[nodiscard]] double mean(double sum) const {
        return ticks_ > 0 ? sum / static_cast<double>(ticks_) : 0.0;
    }

    Sums recorded_, other_;
    uint64_t ticks_ = 0;
    double differenceSum_ = 0.0, maxDifference_ = 0.0, maxDifferenceAt_ = 0.0, maxProxyDistance_ = 0.0;
};

} // namespace touchstone

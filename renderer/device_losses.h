#pragma once
// Limit on replacing lost devices. Pure arithmetic.

#include <array>
#include <cstddef>

namespace touchstone {

/// Occasional device loss leads to a replacement, repeated loss to an error.
class DeviceLosses {
  public:
    static constexpr size_t kMax = 3;
    static constexpr double kWithin = 10.0; ///< s

    /// Records a loss at `now` (s of any monotonic clock). False when it is the third within ten seconds:
    /// give up.
    [[nodiscard]] bool mayReplace(double now) {
        times_[count_ % kMax] = now;
        ++count_;
        return count_ < kMax || now - times_[count_ % kMax] > kWithin;
    }
    [[nodiscard]] size_t count() const { return count_; }

  private:
    std::array<double, kMax> times_{}; ///< of the last losses
    size_t count_ = 0;
};

} // namespace touchstone

#pragma once
// How often a lost device is replaced. Pure arithmetic.

#include <array>
#include <cstddef>

namespace touchstone {

/// A device that is lost now and then is replaced; one that is lost again and again is a broken one.
class DeviceLosses {
  public:
    static constexpr size_t kMax = 3;
    static constexpr double kWithin = 10.0; ///< s

    /// One more, at `now` (s of any clock that only rises). False when it is the third within ten seconds:
    /// give up.
    [[nodiscard]] bool mayReplace(double now) {
        times_[count_ % kMax] = now;
        ++count_;
        return count_ < kMax || now - times_[count_ % kMax] > kWithin;
    }
    [[nodiscard]] size_t count() const { return count_; }

  private:
    std::array<double, kMax> times_{}; ///< of the last ones
    size_t count_ = 0;
};

} // namespace touchstone

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace touchstone {

/// Durations (or any integers) with exact percentiles. Keeps every value, or the newest `window` of them: 8
/// bytes each, so an hour at 1 kHz is 29 MB. One thread; for the reader's side, since it may allocate.
class Samples {
  public:
    /// `window` 0 keeps everything.
    explicit Samples(size_t window = 0) : window_(window) {}

    void add(int64_t value);
    [[nodiscard]] size_t count() const { return values_.size(); }
    [[nodiscard]] bool empty() const { return values_.empty(); }

    /// The smallest kept value that at least the fraction `share` (0..1) of the values does not exceed
    /// (nearest rank). 0 if there are no values.
    [[nodiscard]] int64_t percentile(double share) const;
    /// The number of kept values in each bin: at most `ends[i]` and above the preceding end; one more bin for
    /// values above the last. `ends` increase.
    [[nodiscard]] std::vector<uint64_t> histogram(std::span<const int64_t> ends) const;
    [[nodiscard]] double mean() const;
    [[nodiscard]] int64_t most() const;

  private:
    size_t window_;
    size_t oldest_ = 0;
    std::vector<int64_t> values_;
    mutable std::vector<int64_t> scratch_;
};

} // namespace touchstone

#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace touchstone {

struct MinMax {
    float least = 0.0f, most = 0.0f;
    bool operator==(const MinMax&) const = default;
};

/// Minimum and maximum of any range of a long curve in logarithmic time: no peak is lost, however few pixels
/// there are. Each level holds the extremes of kBranch entries of the one below. Immutable; any thread.
class MinMaxPyramid {
  public:
    MinMaxPyramid() = default;
    explicit MinMaxPyramid(std::vector<float> values);

    [[nodiscard]] size_t size() const { return values_.size(); }
    [[nodiscard]] float operator[](size_t i) const { return values_[i]; }
    /// Of [first, last), which must be non-empty and within the curve.
    [[nodiscard]] MinMax over(size_t first, size_t last) const;

  private:
    static constexpr size_t kBranch = 16;

    std::vector<float> values_;
    std::vector<std::vector<MinMax>> levels_;
};

} // namespace touchstone

#pragma once
// Exact test of the side of a line on which a point lies.

#include <glm/glm.hpp>

#include <array>
#include <cmath>
#include <cstddef>

namespace touchstone {

namespace detail {

/// An exact sum, stored as parts that do not overlap, the smallest first (Shewchuk 1997, "Adaptive precision
/// floating-point arithmetic and fast robust geometric predicates", GROW-EXPANSION).
class ExactSum {
  public:
    void add(double value) {
        for (size_t i = 0; i < count_; ++i) {
            // TWO-SUM: sum + error is value + part exactly.
            const double sum = value + part_[i], back = sum - value;
            part_[i] = (value - (sum - back)) + (part_[i] - back);
            value = sum;
        }
        part_[count_++] = value;
    }
    void addProduct(double a, double b) {
        const double product = a * b;
        add(std::fma(a, b, -product));
        add(product);
    }
    /// Has the same sign as the sum, and agrees with it up to the last bits.
    [[nodiscard]] double estimate() const {
        for (size_t i = count_; i-- > 0;)
            if (part_[i] != 0.0)
                return part_[i];
        return 0.0;
    }

  private:
    std::array<double, 12> part_{};
    size_t count_ = 0;
};

} // namespace detail

/// Twice the area of the triangle p a b, positive when it is counter-clockwise: p is left of the line from a
/// to b. The sign is exact, zero exactly for three collinear points, and swapping a and b negates it: so two
/// triangles that share the edge a b agree about p, whatever the compiler contracts. (Shewchuk's ORIENT2D
/// with one filter stage. Exact while no product of two coordinates under- or overflows.)
[[nodiscard]] inline double orientation(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
    const double left = (a.x - p.x) * (b.y - p.y), right = (a.y - p.y) * (b.x - p.x);
    const double area = left - right;
    constexpr double kFilter = 4.5e-16; // (3 + 16 u) u with u = 2^-53, with a margin
    if (std::abs(area) > kFilter * (std::abs(left) + std::abs(right)))
        return area;
    detail::ExactSum sum;
    sum.addProduct(a.x, b.y);
    sum.addProduct(-a.x, p.y);
    sum.addProduct(-p.x, b.y);
    sum.addProduct(-a.y, b.x);
    sum.addProduct(a.y, p.x);
    sum.addProduct(p.y, b.x);
    return sum.estimate();
}

} // namespace touchstone

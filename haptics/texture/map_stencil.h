#pragma once
// The texels that a place reads along one axis of a map, and their weights: one stencil for each filter and
// gradient. Texel i of a map covers i .. i + 1 and has its centre at i + 1/2; slopes are per texel.

#include <array>
#include <cmath>

namespace touchstone {

/// `count` texels from `first` on: value = sum value[i] T[first + i], slope = sum slope[i] T[first + i].
template <int count>
struct Stencil {
    static constexpr int kCount = count;
    int first = 0;
    std::array<double, static_cast<size_t>(count)> value{}, slope{};
};

/// The texel's own value, a staircase; its slope is zero.
struct NearestStencil {
    using Type = Stencil<1>;
    [[nodiscard]] static Type at(double place) noexcept {
        return {.first = static_cast<int>(std::floor(place)), .value = {1.0}, .slope = {0.0}};
    }
};

/// The staircase, and its difference over half a texel to either side: the step to the nearer neighbour.
struct NearestCentralStencil {
    using Type = Stencil<2>;
    [[nodiscard]] static Type at(double place) noexcept {
        const double first = std::floor(place - 0.5);
        const double second = place - first >= 1.0 ? 1.0 : 0.0; // it contains the place
        return {.first = static_cast<int>(first), .value = {1.0 - second, second}, .slope = {-1.0, 1.0}};
    }
};

/// Linear between two centres, and its derivative.
struct LinearStencil {
    using Type = Stencil<2>;
    [[nodiscard]] static Type at(double place) noexcept {
        const double first = std::floor(place - 0.5), w = place - 0.5 - first;
        return {.first = static_cast<int>(first), .value = {1.0 - w, w}, .slope = {-1.0, 1.0}};
    }
};

/// Catmull and Rom's cubic through the centres, whose slopes there are the central differences, and its
/// derivative. Third order (Keys 1981), continuously differentiable; steps overshoot by 2/27.
struct CubicStencil {
    using Type = Stencil<4>;
    [[nodiscard]] static std::array<double, 4> values(double w) noexcept {
        return {0.5 * w * ((2.0 - w) * w - 1.0), 0.5 * ((3.0 * w - 5.0) * w * w + 2.0),
                0.5 * w * ((4.0 - 3.0 * w) * w + 1.0), 0.5 * (w - 1.0) * w * w};
    }
    [[nodiscard]] static Type at(double place) noexcept {
        const double second = std::floor(place - 0.5), w = place - 0.5 - second;
        return {.first = static_cast<int>(second) - 1,
                .value = values(w),
                .slope = {0.5 * ((4.0 - 3.0 * w) * w - 1.0), 0.5 * (9.0 * w - 10.0) * w,
                          0.5 * ((8.0 - 9.0 * w) * w + 1.0), 0.5 * (3.0 * w - 2.0) * w}};
    }
};

/// The cubic, and its difference over half a texel to either side.
struct CubicCentralStencil {
    using Type = Stencil<5>;
    [[nodiscard]] static Type at(double place) noexcept {
        // The points half a texel to the left and to the right lie in adjacent cells, the place in one of
        // them.
        const double cell = std::floor(place - 1.0), w = place - 1.0 - cell;
        Type stencil{.first = static_cast<int>(cell) - 1};
        const std::array<double, 4> ends = CubicStencil::values(w);
        const bool left = w < 0.5;
        const std::array<double, 4> here = CubicStencil::values(left ? w + 0.5 : w - 0.5);
        for (size_t i = 0; i < 4; ++i) {
            stencil.slope[i] -= ends[i];
            stencil.slope[i + 1] += ends[i];
            stencil.value[left ? i : i + 1] = here[i];
        }
        return stencil;
    }
};

} // namespace touchstone

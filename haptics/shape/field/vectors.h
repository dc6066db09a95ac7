#pragma once
// Eight floats or four doubles at a time, by the compilers' vector extension, as in shape/mesh/triangle_tree.

#include <cstdint>
#include <cstring>

namespace touchstone {

using Eight [[gnu::vector_size(32)]] = float;
using Four [[gnu::vector_size(32)]] = double;
inline constexpr Eight kLane{0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f};

/// From any address.
inline Eight eightAt(const float* values) noexcept {
    Eight eight;
    std::memcpy(&eight, values, sizeof eight);
    return eight;
}
inline Eight smaller(Eight a, Eight b) noexcept {
    return a < b ? a : b;
}
inline Eight larger(Eight a, Eight b) noexcept {
    return a > b ? a : b;
}
inline Four smaller(Four a, Four b) noexcept {
    return a < b ? a : b;
}
inline Four larger(Four a, Four b) noexcept {
    return a > b ? a : b;
}
/// Correctly rounded, as std::sqrt.
inline Eight root(Eight a) noexcept {
    return __builtin_ia32_sqrtps256(a);
}
/// A bit for each number of a comparison that is true, the first one lowest.
inline uint32_t lanes(decltype(Eight{} < Eight{}) which) noexcept {
    return static_cast<uint32_t>(__builtin_ia32_movmskps256(reinterpret_cast<Eight>(which)));
}
inline uint32_t lanes(decltype(Four{} < Four{}) which) noexcept {
    return static_cast<uint32_t>(__builtin_ia32_movmskpd256(reinterpret_cast<Four>(which)));
}
/// By the sign bits of the differences: of numbers that are finite.
inline bool anyLess(Eight a, Eight b) noexcept {
    const Eight less = a - b;
    return __builtin_ia32_movmskps256(less) != 0;
}
inline bool anyLess(Four a, Four b) noexcept {
    const Four less = a - b;
    return __builtin_ia32_movmskpd256(less) != 0;
}

} // namespace touchstone

#pragma once

#include "engine/scene/image.h"
#include "engine/scene/material.h"

#include <algorithm>

namespace touchstone {

/// The texel of 0 .. size - 1 at index i.
[[nodiscard]] inline int wrapIndex(int i, int size, Wrap wrap) noexcept {
    if (i >= 0 && i < size)
        return i; // the case in most ticks, and a division is a quarter of a texel's cost
    switch (wrap) {
    case Wrap::ClampToEdge:
        return std::clamp(i, 0, size - 1);
    case Wrap::MirroredRepeat: {
        const int period = 2 * size;
        const int m = ((i % period) + period) % period;
        return m < size ? m : period - 1 - m;
    }
    case Wrap::Repeat:
        break;
    }
    return ((i % size) + size) % size;
}

/// Factor of a texel's precomputed slope at index i: -1 where the map is mirrored, 0 beyond a clamped edge.
[[nodiscard]] inline double wrapSlope(int i, int size, Wrap wrap) noexcept {
    if ((i >= 0 && i < size) || wrap == Wrap::Repeat)
        return 1.0;
    if (wrap == Wrap::ClampToEdge)
        return 0.0;
    const int period = 2 * size;
    return ((i % period) + period) % period < size ? 1.0 : -1.0;
}

/// Far coordinates carry no fraction and would overflow an int; a texture there is meaningless but must do no
/// harm.
[[nodiscard]] inline double boundedTexel(double x) noexcept {
    return std::max(-1e9, std::min(1e9, x)); // in this order, NaN becomes a number
}

} // namespace touchstone

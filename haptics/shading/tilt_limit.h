#pragma once

#include <cmath>

namespace touchstone {

/// True where two unit vectors of this scalar product are more than `limit` (rad) apart. The cosine of the
/// limit is computed only near it: in most ticks its series, an upper bound from there on, decides.
[[nodiscard]] inline bool leansBeyond(double cosine, double limit) noexcept {
    const double squared = limit * limit;
    return cosine < 1.0 - squared * (0.5 - squared / 24.0) && cosine < std::cos(limit);
}

} // namespace touchstone

#pragma once

#include <cmath>

namespace touchstone {

/// Where a chart's scale ends: the next of 1, 2, 5, 10 … times a power of ten that holds `most` > 0.
inline double niceCeiling(double most) {
    const double decade = std::pow(10.0, std::floor(std::log10(most)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * decade >= most)
            return factor * decade;
    return 10.0 * decade;
}

} // namespace touchstone

#pragma once

#include <cmath>

namespace touchstone {

/// End of a chart's scale: the next of 1, 2, 5, 10 … times a power of ten not below `most` > 0.
inline double niceCeiling(double most) {
    const double decade = std::pow(10.0, std::floor(std::log10(most)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * decade >= most)
            return factor * decade;
    return 10.0 * decade;
}

} // namespace touchstone

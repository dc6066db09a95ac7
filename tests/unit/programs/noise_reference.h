#pragma once
// The library's noise by its definition, in long double.

#include <cmath>
#include <cstdint>

namespace touchstone::program {

inline uint32_t hashOf(uint32_t x) {
    const uint32_t state = x * 747796405u + 2891336453u;
    const uint32_t word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

inline long double slopeOf(uint32_t bits, unsigned shift) {
    return static_cast<long double>((bits >> shift) & 1023u) * 2.0L / 1023.0L - 1.0L;
}

inline long double fadeOf(long double t) {
    return t * t * t * (t * (t * 6.0L - 15.0L) + 10.0L);
}

/// Gradient noise by its definition: a weighted sum over the eight corners.
inline long double noiseAt(long double x, long double y, long double z) {
    const long double p[3] = {x, y, z};
    long double sum = 0.0L;
    for (unsigned corner = 0; corner < 8; ++corner) {
        uint32_t cell[3];
        long double offset[3], weight = 1.0L;
        for (unsigned k = 0; k < 3; ++k) {
            const long double low = std::floor(p[k]), f = p[k] - low;
            const unsigned upper = corner >> k & 1u;
            cell[k] = static_cast<uint32_t>(static_cast<int64_t>(low)) + upper;
            offset[k] = f - static_cast<long double>(upper);
            weight *= upper ? fadeOf(f) : 1.0L - fadeOf(f);
        }
        const uint32_t bits = hashOf(cell[0] + hashOf(cell[1] + hashOf(cell[2])));
        sum += weight *
               (slopeOf(bits, 0) * offset[0] + slopeOf(bits, 10) * offset[1] + slopeOf(bits, 20) * offset[2]);
    }
    return sum * 2.0L / 3.0L;
}

/// The same in one dimension.
inline long double noiseAt(long double x) {
    const long double low = std::floor(x), f = x - low;
    const auto cell = static_cast<uint32_t>(static_cast<int64_t>(low));
    const long double left = slopeOf(hashOf(cell), 0) * f, right = slopeOf(hashOf(cell + 1u), 0) * (f - 1.0L);
    return 2.0L * (left + (right - left) * fadeOf(f));
}

} // namespace touchstone::program

#include "haptics/shape/field/field_relief.h"

#include "engine/core/checksum.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchstone {

namespace {

double clampedDeviation(double value) {
    return std::clamp(value, -FieldRelief::kMostDeviations, FieldRelief::kMostDeviations);
}

/// For a deviation of 1.
double noiseBetween(const FieldRelief& relief, const glm::dvec3& place) {
    const glm::dvec3 grid = place / relief.noiseWavelength;
    const glm::dvec3 cell = glm::floor(grid), t = grid - cell;
    const glm::dvec3 fade = t * t * t * (t * (6.0 * t - 15.0) + 10.0);
    double sum = 0.0, squares = 0.0;
    for (int k = 0; k < 8; ++k) {
        const glm::ivec3 corner(k & 1, k >> 1 & 1, k >> 2);
        const glm::dvec3 each = glm::mix(1.0 - fade, fade, glm::dvec3(corner));
        const double weight = each.x * each.y * each.z;
        sum += weight * gaussianAt(relief.seed, glm::ivec3(cell) + corner);
        squares += weight * weight;
    }
    return sum / std::sqrt(squares);
}

} // namespace

double gaussianAt(uint64_t seed, const glm::ivec3& at) {
    Hash64 hash;
    hash.add(seed);
    for (int axis = 0; axis < 3; ++axis)
        hash.add(at[axis]);
    hash.add(0); // one more round, so that the last coordinate reaches all bits
    const uint64_t bits = hash.value();
    constexpr double kUnit = 0x1p-32;
    const double u = (static_cast<double>(bits >> 32) + 0.5) * kUnit,
                 v = static_cast<double>(bits & 0xffffffffu) * kUnit;
    return clampedDeviation(std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v));
}

double reliefAt(const FieldRelief& relief, const glm::dvec3& place, const glm::ivec3& node) {
    double height = 0.0;
    if (relief.noise != 0.0)
        height += relief.noise * (relief.noiseWavelength > 0.0 ? clampedDeviation(noiseBetween(relief, place))
                                                               : gaussianAt(relief.seed, node));
    if (relief.lattice != 0.0) {
        const glm::dvec3 wave = glm::cos(2.0 * std::numbers::pi / relief.latticeWavelength * place);
        height += relief.lattice / 3.0 * (wave.x + wave.y + wave.z);
    }
    return height;
}

double reliefShare(double f, double whole, double limit) {
    const double away = std::abs(f);
    return away <= whole ? 1.0 : std::clamp((limit - away) / (limit - whole), 0.0, 1.0);
}

} // namespace touchstone

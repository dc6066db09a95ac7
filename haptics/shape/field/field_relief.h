#pragma once
// Texture in the values of a field [002 section 4.4]: heights that are subtracted from its nodes when it is
// built. Nothing of it is in a tick.

#include <glm/glm.hpp>

#include <cstdint>

namespace touchstone {

/// Object units, object frame.
struct FieldRelief {
    double noise = 0.0;           ///< standard deviation; 0: no noise
    double noiseWavelength = 0.0; ///< distance between its values; 0: each node has its own, as in the paper
    uint64_t seed = 0;
    double lattice = 0.0;           ///< of the highest and lowest places; 0: no lattice
    double latticeWavelength = 0.0; ///< above 0 where there is a lattice
    bool operator==(const FieldRelief&) const = default;

    [[nodiscard]] bool empty() const { return noise == 0.0 && lattice == 0.0; }
    /// An upper bound of |reliefAt|.
    [[nodiscard]] double highest() const { return kMostDeviations * noise + lattice; }
    static constexpr double kMostDeviations = 4.0; ///< the noise is clamped there: 6 values in 100,000
};

/// A value of the normal distribution of mean 0 and deviation 1, clamped to kMostDeviations: the Box-Muller
/// transform of a hash of the numbers.
[[nodiscard]] double gaussianAt(uint64_t seed, const glm::ivec3& at);

/// Height at a place, noise plus lattice. `node`: of the grid, for noise without a wavelength.
///
/// Noise of a wavelength has values g_i at the corners of cells of that size, and between them
/// sum(w_i g_i) / sqrt(sum(w_i^2)), where w_i are the trilinear weights of the faded coordinates
/// 6 t^5 - 15 t^4 + 10 t^3: the same distribution everywhere (but for the clamp), continuous in its second
/// derivatives.
/// The lattice is a / 3 (cos(2 pi x / l) + cos(2 pi y / l) + cos(2 pi z / l)).
[[nodiscard]] double reliefAt(const FieldRelief& relief, const glm::dvec3& place, const glm::ivec3& node);

/// The fraction of the relief that is laid on a node of distance f: 1 up to `whole` from the surface, from
/// there linear to 0 at `limit`, where the field ends.
[[nodiscard]] double reliefShare(double f, double whole, double limit);

} // namespace touchstone

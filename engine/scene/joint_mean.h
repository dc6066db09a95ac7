#pragma once

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace touchstone {

/// The mean of the joints' matrices by the weights of one vertex, one weight for each entry of `joints`, with
/// a positive sum. Divided by the sum in double: weights are floats, and the rounding of their sum times the
/// distance of the joints from the scene's origin would move the vertex.
inline glm::dmat4 meanOfJoints(std::span<const float> weights, std::span<const uint32_t> joints,
                               std::span<const glm::dmat4> matrices) noexcept {
    glm::dmat4 sum(0.0);
    double total = 0.0;
    for (size_t k = 0; k < weights.size(); ++k) {
        const double weight = weights[k];
        if (weight == 0.0) // its joint may be none
            continue;
        sum += weight * matrices[joints[k]];
        total += weight;
    }
    return sum / total;
}

} // namespace touchstone

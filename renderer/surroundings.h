#pragma once
// Ambient light: a procedural sky, floor and lamps. Irradiance and prefiltered reflection both have a closed
// form, so nothing is loaded or precomputed. Pure; any thread.

#include <glm/glm.hpp>

#include <array>

namespace touchstone {

/// A soft lamp: radiance / (1 + sharpness (1 - cos))² around the direction towards it; the shape of the GGX
/// lobe, so that its blurred reflection is cheap.
struct Lamp {
    glm::dvec3 towards{0.0, 1.0, 0.0}; ///< workspace; need not be unit
    glm::vec3 radiance{0.0f};          ///< linear RGB, at its centre
    double sharpness = 8.0;            ///< > 0; falls to half within acos(1 - 0.414 / sharpness): 19° for 8
    bool operator==(const Lamp&) const = default;
};

/// Linear RGB radiance by direction; y of the workspace is up. Between horizon and zenith, and between the
/// floor's border and its centre (straight below), it is linear in the sine of the elevation.
struct Surroundings {
    glm::vec3 zenith{0.44f, 0.47f, 0.52f};
    glm::vec3 horizon{0.60f, 0.61f, 0.63f};
    glm::vec3 rim{0.44f, 0.43f, 0.42f};
    glm::vec3 below{0.10f, 0.097f, 0.094f};
    std::array<Lamp, 2> lamps{};
    bool operator==(const Surroundings&) const = default;

    [[nodiscard]] static Surroundings dark() {
        return {glm::vec3(0.0f), glm::vec3(0.0f), glm::vec3(0.0f), glm::vec3(0.0f), {}};
    }
};

/// Radiance from a unit direction.
[[nodiscard]] glm::dvec3 radianceFrom(const Surroundings& surroundings, const glm::dvec3& direction);

/// Irradiance / pi at a unit normal n, as the polynomial k0 + k1 x + k2 y + k3 z + k4 xy + k5 yz + k6 zx + k7
/// x² + k8 y²: its spherical harmonics up to the second degree (Ramamoorthi and Hanrahan, "An efficient
/// representation for irradiance environment maps", 2001), each from the closed form of its integral. From k4
/// on the renderer uses the mean of the channels: these terms are at most a fifth of the light, and this
/// halves the cost.
[[nodiscard]] std::array<glm::dvec3, 9> irradiancePolynomial(const Surroundings& surroundings);

} // namespace touchstone

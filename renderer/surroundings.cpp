#include "renderer/surroundings.h"

#include <cmath>

namespace touchstone {

namespace {

/// A function of the cosine x to an axis, a0 + a1 P1(x) + a2 P2(x) in Legendre polynomials.
struct Zonal {
    glm::dvec3 a0, a1, a2;
};

/// s0 + s1 x above, g0 - g1 x below: integrals of the pieces with 1/2, 3/2 x and 5/4 (3x² - 1).
Zonal skyZonal(const Surroundings& sky) {
    const glm::dvec3 s0(sky.horizon), s1(sky.zenith - sky.horizon);
    const glm::dvec3 g0(sky.rim), g1(sky.below - sky.rim);
    return {0.5 * (s0 + g0) + 0.25 * (s1 + g1), 0.75 * (s0 - g0) + 0.5 * (s1 - g1), 0.3125 * (s1 + g1)};
}

/// 1 / u² with u = 1 + s (1 - x), so x = a - u / s: the integrals of 1, x and x² times it over x are those of
/// powers of u.
Zonal lampZonal(const Lamp& lamp) {
    const double s = lamp.sharpness, a = 1.0 + 1.0 / s, last = 1.0 + 2.0 * s,
                 logarithm = std::log(last) / (s * s);
    const double i0 = 2.0 / last;
    const double i1 = a * i0 - logarithm;
    const double i2 = a * a * i0 - 2.0 * a * logarithm + 2.0 / (s * s);
    const glm::dvec3 radiance(lamp.radiance);
    return {0.5 * i0 * radiance, 1.5 * i1 * radiance, 1.25 * (3.0 * i2 - i0) * radiance};
}

/// Adds the irradiance / pi of a zonal radiance about unit `axis`: the cosine lobe scales degrees 0, 1, 2 by
/// 1, 2/3, 1/4.
void add(const Zonal& zonal, const glm::dvec3& axis, std::array<glm::dvec3, 9>& k) {
    const glm::dvec3 linear = (2.0 / 3.0) * zonal.a1, square = 0.375 * zonal.a2; // P2 = (3 x² - 1) / 2
    // x², y², z² with weights: z² is 1 - x² - y² on the sphere.
    const glm::dvec3 w = axis * axis;
    k[0] += zonal.a0 - 0.125 * zonal.a2 + square * w.z;
    k[1] += linear * axis.x;
    k[2] += linear * axis.y;
    k[3] += linear * axis.z;
    k[4] += square * (2.0 * axis.x * axis.y);
    k[5] += square * (2.0 * axis.y * axis.z);
    k[6] += square * (2.0 * axis.z * axis.x);
    k[7] += square * (w.x - w.z);
    k[8] += square * (w.y - w.z);
}

} // namespace

glm::dvec3 radianceFrom(const Surroundings& surroundings, const glm::dvec3& direction) {
    const double y = direction.y;
    glm::dvec3 radiance = y >= 0.0
                              ? glm::mix(glm::dvec3(surroundings.horizon), glm::dvec3(surroundings.zenith), y)
                              : glm::mix(glm::dvec3(surroundings.rim), glm::dvec3(surroundings.below), -y);
    for (const Lamp& lamp : surroundings.lamps)
        if (lamp.radiance != glm::vec3(0.0f)) {
            const double u = 1.0 + lamp.sharpness * (1.0 - glm::dot(glm::normalize(lamp.towards), direction));
            radiance += glm::dvec3(lamp.radiance) / (u * u);
        }
    return radiance;
}

std::array<glm::dvec3, 9> irradiancePolynomial(const Surroundings& surroundings) {
    std::array<glm::dvec3, 9> k{};
    add(skyZonal(surroundings), {0.0, 1.0, 0.0}, k);
    for (const Lamp& lamp : surroundings.lamps)
        if (lamp.radiance != glm::vec3(0.0f))
            add(lampZonal(lamp), glm::normalize(lamp.towards), k);
    return k;
}

} // namespace touchstone

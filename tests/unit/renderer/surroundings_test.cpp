#include "renderer/surroundings.h"

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace touchstone {
namespace {

/// Irradiance / pi by summing over a grid of equal areas on the sphere.
glm::dvec3 summed(const Surroundings& surroundings, const glm::dvec3& normal) {
    constexpr int kHeights = 400, kTurns = 400;
    glm::dvec3 sum(0.0);
    for (int i = 0; i < kHeights; ++i)
        for (int j = 0; j < kTurns; ++j) {
            const double y = -1.0 + 2.0 * (i + 0.5) / kHeights,
                         angle = glm::two_pi<double>() * (j + 0.5) / kTurns;
            const double across = std::sqrt(1.0 - y * y);
            const glm::dvec3 direction(across * std::cos(angle), y, across * std::sin(angle));
            sum += radianceFrom(surroundings, direction) * std::max(0.0, glm::dot(direction, normal));
        }
    return 4.0 * sum / (1.0 * kHeights * kTurns);
}

glm::dvec3 evaluated(const std::array<glm::dvec3, 9>& k, const glm::dvec3& n) {
    return k[0] + k[1] * n.x + k[2] * n.y + k[3] * n.z + k[4] * (n.x * n.y) + k[5] * (n.y * n.z) +
           k[6] * (n.z * n.x) + k[7] * (n.x * n.x) + k[8] * (n.y * n.y);
}

const std::array<glm::dvec3, 7> kNormals{glm::dvec3(1.0, 0.0, 0.0),     glm::dvec3(0.0, 1.0, 0.0),
                                         glm::dvec3(0.0, 0.0, 1.0),     glm::dvec3(0.0, -1.0, 0.0),
                                         glm::dvec3(0.6, 0.0, -0.8),    glm::dvec3(-0.48, 0.6, 0.64),
                                         glm::dvec3(-0.48, -0.6, -0.64)};

TEST(Surroundings, AUniformSkyLightsEverythingAlike) {
    const glm::vec3 grey(0.7f);
    const auto k = irradiancePolynomial({grey, grey, grey, grey, {}});
    for (const glm::dvec3& n : kNormals)
        EXPECT_NEAR(evaluated(k, n).x, 0.7, 1e-7);
}

TEST(Surroundings, TheSkysIrradianceIsItsIntegral) {
    // Beyond the second degree the cosine lobe has 4 % of its power, and this sky a part of that.
    const Surroundings sky;
    const auto k = irradiancePolynomial(sky);
    for (const glm::dvec3& n : kNormals)
        EXPECT_NEAR(evaluated(k, n).y, summed(sky, n).y, 0.005);
}

TEST(Surroundings, TheLampsIrradianceIsItsIntegralWithinWhatTheSecondDegreeHolds) {
    for (const double sharpness : {0.5, 3.0, 12.0}) {
        Surroundings lamps = Surroundings::dark();
        lamps.lamps[0] = {{0.48, -0.6, 0.64}, glm::vec3(2.0f), sharpness};
        lamps.lamps[1] = {{-3.0, 1.0, 0.5}, glm::vec3(0.5f), 2.0 * sharpness};
        const auto k = irradiancePolynomial(lamps);
        double brightest = 0.0;
        for (const glm::dvec3& n : kNormals)
            brightest = std::max(brightest, summed(lamps, n).x);
        for (const glm::dvec3& n : kNormals)
            EXPECT_NEAR(evaluated(k, n).x, summed(lamps, n).x, 0.09 * brightest) << sharpness;
    }
}

} // namespace
} // namespace touchstone

// Panoramas as light: directions, irradiance and blurs.

#include "renderer/environment.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/packing.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace touchstone {
namespace {

glm::dvec3 directionAt(double u, double v) {
    const double turn = glm::two_pi<double>() * (u - 0.5), fall = glm::pi<double>() * v;
    return {std::sin(fall) * std::sin(turn), std::cos(fall), -std::sin(fall) * std::cos(turn)};
}

Panorama panorama(int width, const std::function<glm::vec3(const glm::dvec3&)>& radiance) {
    Panorama made{width, width / 2, {}};
    for (int y = 0; y < made.height; ++y)
        for (int x = 0; x < width; ++x)
            made.texels.push_back(radiance(directionAt((x + 0.5) / width, (y + 0.5) / made.height)));
    return made;
}

glm::dvec3 irradianceAt(const Environment& environment, const glm::dvec3& n) {
    const auto& k = environment.irradiance;
    return k[0] + k[1] * n.x + k[2] * n.y + k[3] * n.z + k[4] * (n.x * n.y) + k[5] * (n.y * n.z) +
           k[6] * (n.z * n.x) + k[7] * (n.x * n.x) + k[8] * (n.y * n.y);
}

/// The texel of a level, and where it looks.
void eachTexel(const Environment& environment, int level,
               const std::function<void(const glm::dvec3& direction, const glm::vec3& radiance)>& visit) {
    const int side = Environment::kSide >> level;
    const std::vector<uint16_t>& texels = environment.levels[static_cast<size_t>(level)];
    ASSERT_EQ(texels.size(), size_t{24} * static_cast<size_t>(side) * static_cast<size_t>(side));
    size_t at = 0;
    for (int face = 0; face < 6; ++face)
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x, at += 4)
                visit(cubeDirection(face, (x + 0.5) / side, (y + 0.5) / side),
                      {glm::unpackHalf1x16(texels[at]), glm::unpackHalf1x16(texels[at + 1]),
                       glm::unpackHalf1x16(texels[at + 2])});
}

TEST(Environment, AUniformOneIsUniformAtEveryBlurAndOfTheBrightnessThatWeWant) {
    const auto made = prefilter(panorama(64, [](const glm::dvec3&) { return glm::vec3(37.0f); }));
    ASSERT_TRUE(made);
    for (int level = 0; level < Environment::kLevels; ++level)
        eachTexel(*made, level, [](const glm::dvec3&, const glm::vec3& radiance) {
            EXPECT_NEAR(radiance.y, Environment::kMeanRadiance, 1e-3);
        });
    for (const glm::dvec3& n : {glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0.6, 0, 0.8)})
        EXPECT_NEAR(irradianceAt(*made, n).y, Environment::kMeanRadiance, 1e-3);
}

TEST(Environment, ALinearSkyHasTheIrradianceOfItsIntegral) {
    // Radiance 1 + d.y / 2 + d.x / 4: irradiance / pi is 1 + (2/3) (y / 2 + x / 4).
    const auto made = prefilter(panorama(256, [](const glm::dvec3& d) {
        return glm::vec3(static_cast<float>(1.0 + 0.5 * d.y + 0.25 * d.x));
    }));
    ASSERT_TRUE(made);
    for (const glm::dvec3& n :
         {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1), glm::dvec3(-0.48, -0.6, 0.64)})
        EXPECT_NEAR(irradianceAt(*made, n).x,
                    Environment::kMeanRadiance * (1.0 + 2.0 / 3.0 * (0.5 * n.y + 0.25 * n.x)), 2e-3);
}

TEST(Environment, ASunIsSeenWhereItIsAndWiderWhereItIsBlurred) {
    for (const glm::dvec3& sun : {glm::normalize(glm::dvec3(0.5, 0.3, -0.8)), glm::dvec3(-1, 0, 0),
                                  glm::normalize(glm::dvec3(0.1, -0.9, 0.3))}) {
        const auto made = prefilter(panorama(512, [&](const glm::dvec3& d) {
            return glm::dot(d, sun) > 0.995 ? glm::vec3(100.0f, 50.0f, 25.0f) : glm::vec3(0.01f);
        }));
        ASSERT_TRUE(made);
        double brightestBefore = std::numeric_limits<double>::infinity();
        for (int level = 0; level < Environment::kLevels; ++level) {
            glm::dvec3 centre(0.0);
            double brightest = 0.0;
            eachTexel(*made, level, [&](const glm::dvec3& d, const glm::vec3& radiance) {
                EXPECT_TRUE(radiance.x >= radiance.y && radiance.y >= radiance.z);
                // A texel of a face's corner spans less of the sphere.
                const double largest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
                centre += static_cast<double>(radiance.x) * std::pow(largest, 3.0) * d;
                brightest = std::max(brightest, static_cast<double>(radiance.x));
            });
            // The coarse levels of the panorama, from which blurs are read, pull up to 6° towards its poles.
            EXPECT_GT(glm::dot(glm::normalize(centre), sun), level == 0 ? 0.999 : 0.993) << "level " << level;
            EXPECT_LT(brightest, 1.02 * brightestBefore) << "level " << level;
            brightestBefore = brightest;
        }
        EXPECT_GT(glm::dot(glm::normalize(glm::dvec3(made->irradiance[1].x, made->irradiance[2].x,
                                                     made->irradiance[3].x)),
                           sun),
                  0.999);
    }
}

TEST(Environment, ABlackOneIsNone) {
    EXPECT_FALSE(prefilter(panorama(16, [](const glm::dvec3&) { return glm::vec3(0.0f); })));
}

TEST(Environment, CancellingEndsIt) {
    const std::atomic<bool> cancel = true;
    EXPECT_FALSE(prefilter(panorama(16, [](const glm::dvec3&) { return glm::vec3(1.0f); }), &cancel));
}

} // namespace
} // namespace touchstone

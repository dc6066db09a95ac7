// The fits of shaders/shared/closed_forms.h against the integrals that they stand for.

#include "shaders/shared/closed_forms.h"

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace touchstone {
namespace {

/// Integral over the half vectors of GGX, each as often as it occurs.
double ggxIntegral(double nv, double roughness) {
    const double alpha = roughness * roughness, a2 = alpha * alpha, vx = std::sqrt(1.0 - nv * nv);
    constexpr int kHeights = 128, kTurns = 128;
    double sum = 0.0;
    for (int i = 0; i < kHeights; ++i)
        for (int j = 0; j < kTurns; ++j) {
            const double u = (i + 0.5) / kHeights, turn = glm::two_pi<double>() * (j + 0.5) / kTurns;
            const double hz = std::sqrt((1.0 - u) / (1.0 + (a2 - 1.0) * u)),
                         hx = std::sqrt(1.0 - hz * hz) * std::cos(turn);
            const double vh = vx * hx + nv * hz, nl = 2.0 * vh * hz - nv;
            if (vh > 0.0 && nl > 0.0)
                sum += 0.5 / ((1.0 - alpha) * 2.0 * nl * nv + alpha * (nl + nv)) * nl * 4.0 * vh / hz;
        }
    return sum / (kHeights * kTurns);
}

double sheenIntegral(double nv, double roughness) {
    const double inverse = 1.0 / (roughness * roughness), vx = std::sqrt(1.0 - nv * nv);
    constexpr int kHeights = 400, kTurns = 200;
    double sum = 0.0;
    for (int i = 0; i < kHeights; ++i)
        for (int j = 0; j < kTurns; ++j) {
            const double nl = (i + 0.5) / kHeights, turn = glm::pi<double>() * (j + 0.5) / kTurns;
            const double across = std::sqrt(1.0 - nl * nl);
            const glm::dvec3 h =
                glm::normalize(glm::dvec3(across * std::cos(turn) + vx, across * std::sin(turn), nl + nv));
            const double d =
                (2.0 + inverse) * std::pow(1.0 - h.z * h.z, 0.5 * inverse) / glm::two_pi<double>();
            sum += d * nl / (4.0 * (nl + nv - nl * nv));
        }
    return sum * glm::two_pi<double>() / (kHeights * kTurns);
}

TEST(ClosedForms, TheAlbedoOfGgxIsItsIntegral) {
    EXPECT_NEAR(ggxIntegral(1.0, 1.0), 1.0 - std::log(2.0), 1e-3) << "known exactly";
    for (const double roughness : {0.2, 0.35, 0.5, 0.7, 0.85, 1.0})
        for (const double nv : {0.1, 0.2, 0.4, 0.6, 0.8, 1.0}) {
            const double exact = ggxIntegral(nv, roughness);
            EXPECT_NEAR(shared::ggxAlbedo(static_cast<float>(nv), static_cast<float>(roughness)), exact,
                        0.06 * exact)
                << "roughness " << roughness << ", cosine " << nv;
        }
    EXPECT_NEAR(shared::ggxAlbedo(0.7f, 0.06f), 1.0f, 0.1f) << "a mirror";
}

TEST(ClosedForms, TheAlbedoOfSheenIsItsIntegral) {
    for (const double roughness : {0.15, 0.3, 0.5, 0.75, 1.0})
        for (const double nv : {0.1, 0.25, 0.5, 0.75, 1.0})
            EXPECT_NEAR(shared::sheenAlbedo(static_cast<float>(nv), static_cast<float>(roughness)),
                        std::min(sheenIntegral(nv, roughness), 1.0), 0.04)
                << "roughness " << roughness << ", cosine " << nv;
}

} // namespace
} // namespace touchstone

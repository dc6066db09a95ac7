// The pose of a moving object is a similarity whatever matrix an animation makes: generated files with
// flattening scales gave a rotation that is not a number, and it went through the proxy to the force.
#include "engine/math/nearest_similarity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace touchstone::nearest_similarity_test {
namespace {

glm::dvec3 anyDirection(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return {normal(random), normal(random), normal(random)};
}

TEST(NearestSimilarity, OfASimilarityIsThatSimilarity) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> exponent(-8.0, 8.0);
    for (int i = 0; i < 2000; ++i) {
        const Similarity made{std::pow(10.0, exponent(random)),
                              glm::normalize(glm::dquat(1.0, 0.3 * anyDirection(random))),
                              anyDirection(random)};
        Similarity found;
        ASSERT_TRUE(nearestSimilarity(matrixOf(made), found));
        EXPECT_NEAR(found.scale / made.scale, 1.0, 1e-12);
        EXPECT_NEAR(std::abs(glm::dot(found.rotation, made.rotation)), 1.0, 1e-12);
        EXPECT_EQ(found.translation, made.translation);
    }
}

TEST(NearestSimilarity, OfWhateverElseIsASimilarityOrNone) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> exponent(-170.0, 170.0), small(-18.0, 0.0);
    int taken = 0, refused = 0;
    for (int i = 0; i < 200000; ++i) {
        const glm::dvec3 a = anyDirection(random), b = anyDirection(random), c = anyDirection(random);
        const double size = i % 2 == 0 ? 1.0 : std::pow(10.0, exponent(random));
        glm::dmat4 matrix(1.0);
        // Columns that lie in a plane, or along a line, but for a little or nothing.
        const double off = i % 3 == 0 ? 0.0 : std::pow(10.0, small(random));
        matrix[0] = glm::dvec4(size * a, 0.0);
        matrix[1] = glm::dvec4(size * (i % 5 == 0 ? b : 0.7 * a + off * b), 0.0);
        matrix[2] =
            glm::dvec4(size * (i % 7 == 0 ? c : 0.3 * a - 0.2 * glm::dvec3(matrix[1]) / size + off * c), 0.0);
        if (i % 4 == 0) // uneven beyond what squares of lengths can hold
            for (int column = 0; column < 3; ++column)
                matrix[column] *= std::pow(10.0, exponent(random));
        const Similarity before{2.0, glm::dquat(1.0, 0.0, 0.0, 0.0), glm::dvec3(1.0)};
        Similarity found = before;
        if (!nearestSimilarity(matrix, found)) {
            ++refused;
            EXPECT_EQ(found.scale, before.scale);
            EXPECT_EQ(found.rotation, before.rotation);
            continue;
        }
        ++taken;
        ASSERT_TRUE(std::isfinite(found.scale) && found.scale > 0.0);
        ASSERT_NEAR(glm::length(found.rotation), 1.0, 1e-9) << i;
    }
    EXPECT_GT(taken, 10000);
    EXPECT_GT(refused, 10000);
}

} // namespace
} // namespace touchstone::nearest_similarity_test

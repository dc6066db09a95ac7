// Angles between facets where they are known, and the advice that follows from them.

#include "study/perception/perceptual_check.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace touchstone::study::perceptual_check_test {
namespace {

PerceptualCheck checked(const assets::Shape& shape) {
    return checkPerception(*compileHapticScene(test::sceneOf(shape), Similarity{}));
}

const FacetCheck& rowOf(const PerceptualCheck& check, const std::string& condition) {
    for (const FacetCheck& row : check.limits)
        if (condition == row.limit.condition)
            return row;
    throw std::runtime_error("no such condition");
}

TEST(PerceptualCheck, TheLimitsAreThoseOfTheStudy) {
    std::string all;
    for (const FacetLimit& limit : facetLimits())
        all += std::string(limit.condition) + " " + std::to_string(limit.degrees).substr(0, 4) + "; ";
    EXPECT_EQ(all, "C1 0.50; C2 3.40; C3 0.20; C4 3.50; P1 14.8; ");
}

TEST(PerceptualCheck, CountsTheEdgesOfAPrismByTheirAngle) {
    // Ten sides of 36 degrees; the diagonals of its faces are flat, its caps meet the sides at 90 degrees.
    const PerceptualCheck smooth = checked(assets::prism(10, 0.05, 0.2, true));
    EXPECT_TRUE(smooth.anySmooth);
    EXPECT_NEAR(smooth.largest, 36.0, 1e-4);
    EXPECT_EQ(smooth.creases, 20u) << "the rims of both caps";
    for (const char* condition : {"C1", "C2", "C3", "C4", "P1"})
        EXPECT_EQ(rowOf(smooth, condition).beyond, 10u) << condition;
    const PerceptualCheck flat = checked(assets::prism(10, 0.05, 0.2, false));
    EXPECT_FALSE(flat.anySmooth);
}

TEST(PerceptualCheck, SidesJustBelowAndAboveALimit) {
    // 360 / 720 = 0.5 degrees exactly, so 730 sides are below C1's limit and 710 above.
    EXPECT_EQ(rowOf(checked(assets::prism(730, 0.05, 0.2, true)), "C1").beyond, 0u);
    const PerceptualCheck above = checked(assets::prism(710, 0.05, 0.2, true));
    EXPECT_EQ(rowOf(above, "C1").beyond, 710u);
    ASSERT_TRUE(rowOf(above, "C1").needed.has_value());
    EXPECT_NEAR(static_cast<double>(*rowOf(above, "C1").needed) / static_cast<double>(above.triangles),
                std::pow(720.0 / 710.0, 2.0), 0.01);
}

TEST(PerceptualCheck, TakesTheSmallestMeshes) {
    // Two triangles in a plane, less than any level keeps.
    const PerceptualCheck check = checked(assets::plane(0.1, 0.1));
    EXPECT_EQ(check.triangles, 2u);
    EXPECT_EQ(check.edges, 1u);
    EXPECT_EQ(rowOf(check, "C3").beyond, 0u);
    EXPECT_EQ(rowOf(check, "C3").enough, std::optional<size_t>(2));
}

TEST(PerceptualCheck, FewerTrianglesWouldDoWhereTheFacetsAreFine) {
    const PerceptualCheck check = checked(assets::torus(0.05, 0.02, 240, 120));
    const FacetCheck& shaded = rowOf(check, "C2");
    ASSERT_TRUE(check.simplified);
    ASSERT_TRUE(shaded.enough.has_value());
    EXPECT_LT(*shaded.enough, check.triangles);
    EXPECT_GT(*shaded.enough, check.triangles / 20) << "facets of the torus meet at 1.5 and 3 degrees";
    EXPECT_GE(shaded.error, 0.0);
    EXPECT_LT(shaded.error, 0.5e-3);
    ASSERT_TRUE(rowOf(check, "P1").enough.has_value());
    EXPECT_LE(*rowOf(check, "P1").enough, *shaded.enough);
    EXPECT_FALSE(rowOf(check, "C3").enough.has_value());
}

} // namespace
} // namespace touchstone::study::perceptual_check_test

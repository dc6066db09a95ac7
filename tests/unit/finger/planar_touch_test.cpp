// The finger on polylines and arcs [004 §4.1, §5]: proxies by hand, force shading, nothing allocated.

#include "haptics/finger/planar_touch.h"
#include "tests/support/allocation_counter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace touchstone::test {
namespace {

FingerPose padAt(double x, double y) {
    return {.pad = {x, y}};
}

TEST(PlanarTouch, PressesAgainstAnEdgeByHookesLaw) {
    const std::vector<glm::dvec2> flat{{-0.1, 0.0}, {0.1, 0.0}};
    const PlanarSurface surface{Polyline(flat, false)};
    PlanarTouch touch(surface, {.location = PlanarLocation::Facets, .stiffness = 500.0});
    const auto felt = touch.step(padAt(0.01, -0.002));
    EXPECT_TRUE(felt.touching);
    EXPECT_NEAR(felt.force.y, 1.0, 1e-12);
    EXPECT_NEAR(felt.force.x, 0.0, 1e-12);
    EXPECT_NEAR(felt.location, 0.0, 1e-12);
    EXPECT_FALSE(touch.step(padAt(0.01, 0.001)).touching);
    FingerPose tilted = padAt(0.0, -0.002);
    tilted.pitch = 0.2;
    EXPECT_NEAR(touch.step(tilted).location, -0.020 * 0.2, 1e-9)
        << "the pad is turned, the contact moves back";
    tilted.pitch = 1.0;
    EXPECT_NEAR(touch.step(tilted).location, -0.008, 1e-12) << "at the end of the pad";
}

/// Over a vertex the circle rolls: the force points from the vertex to the centre, and turns without a jump.
TEST(PlanarTouch, RollsOverAVertexWithoutAJump) {
    const SmoothArc arc;
    const PlanarSurface surface(polygonOf(arc, 12));
    PlanarTouch touch(surface, {.location = PlanarLocation::Facets});
    glm::dvec2 last(0.0);
    double place = 0.0, most = 0.0, moved = 0.0;
    bool first = true;
    for (double at = -0.3; at <= 0.3; at += 1e-6) {
        const glm::dvec2 normal(std::sin(at), std::cos(at));
        const auto felt = touch.step(
            {.pad = arc.centre() + (arc.radius + 0.020 - 0.002) * normal - glm::dvec2(0.0, 0.020)});
        ASSERT_TRUE(felt.touching);
        if (!first) {
            most = std::max(most, glm::distance(felt.force, last));
            moved = std::max(moved, std::abs(felt.location - place));
        }
        first = false;
        last = felt.force;
        place = felt.location;
    }
    // A step of 0.118 um: over a vertex the normal turns by that through 18 mm.
    EXPECT_LT(most, 2e-5) << "N";
    EXPECT_LT(moved, 2e-7) << "m";
}

/// In the corner of two walls the proxy touches both: the force is the sum of theirs.
TEST(PlanarTouch, StandsInACornerOfTwoWalls) {
    const std::vector<glm::dvec2> valley{{-0.1, 0.1}, {0.0, 0.0}, {0.1, 0.1}};
    const PlanarSurface surface{Polyline(valley, false)};
    PlanarTouch touch(surface, {.stiffness = 1000.0});
    // A free circle of 20 mm rests with its centre at 20 mm sqrt 2; this one is 1 mm deeper, and beside.
    const auto felt = touch.step(padAt(0.0, 0.020 * std::sqrt(2.0) - 0.020 - 0.001));
    EXPECT_NEAR(felt.force.y, 1.0, 1e-9);
    EXPECT_NEAR(felt.force.x, 0.0, 1e-9);
    const auto beside = touch.step(padAt(0.0002, 0.020 * std::sqrt(2.0) - 0.020 - 0.001));
    EXPECT_NEAR(beside.force.x, -0.2, 1e-9);
    EXPECT_NEAR(beside.force.y, 1.0, 1e-9);
}

/// Morgenbesser and Srinivasan: between vertices the direction is that of the circle through them, nearly.
TEST(PlanarTouch, ShadesTheDirectionOfTheForce) {
    const SmoothArc arc;
    const PlanarSurface polygon(polygonOf(arc, 12)), smooth(arc);
    PlanarTouch facets(polygon), shaded(polygon, {.force = PlanarForce::Shaded}),
        bezier(polygon, {.force = PlanarForce::Bezier, .step = TangentStep::Solved}), exact(smooth);
    double worstFacets = 0.0, worstShaded = 0.0, worstBezier = 0.0;
    const auto angle = [](const glm::dvec2& a, const glm::dvec2& b) {
        return std::abs(std::atan2(crossed(a, b), glm::dot(a, b)));
    };
    for (double at = -0.3; at <= 0.3; at += 1e-4) {
        const glm::dvec2 normal(std::sin(at), std::cos(at));
        const FingerPose pose{.pad = arc.centre() + (arc.radius + 0.020 - 0.002) * normal -
                                     glm::dvec2(0.0, 0.020)};
        const glm::dvec2 truth = exact.step(pose).normal;
        worstFacets = std::max(worstFacets, angle(facets.step(pose).normal, truth));
        worstShaded = std::max(worstShaded, angle(shaded.step(pose).normal, truth));
        worstBezier = std::max(worstBezier, angle(bezier.step(pose).normal, truth));
    }
    EXPECT_NEAR(worstFacets, 0.5 * 0.902 / 12.0, 0.01);
    EXPECT_LT(worstShaded, 0.3 * worstFacets);
    EXPECT_LT(worstBezier, 0.02 * worstFacets);
    std::printf("turn from the arc's force, 12 segments: facets %.2f, shaded %.3f, bezier %.4f degrees\n",
                worstFacets * 57.2958, worstShaded * 57.2958, worstBezier * 57.2958);
}

TEST(PlanarTouch, FeelsNothingBeyondTheArcNorOfAPlaceThatIsNone) {
    const PlanarSurface smooth{SmoothArc{}};
    PlanarTouch touch(smooth);
    EXPECT_TRUE(touch.step(padAt(0.0, -0.001)).touching);
    EXPECT_FALSE(touch.step(padAt(0.09, -0.05)).touching);
    EXPECT_EQ(touch.step(padAt(std::nan(""), 0.0)).force, glm::dvec2(0.0));
    EXPECT_EQ(touch.step(padAt(0.0, std::numeric_limits<double>::infinity())).force, glm::dvec2(0.0));
}

TEST(PlanarTouch, AllocatesNothing) {
    const PlanarSurface surface(polygonOf({}, 40));
    PlanarTouch touch(surface, {.force = PlanarForce::Bezier, .location = PlanarLocation::Bezier});
    const uint64_t before = allocationsOnThisThread();
    for (double x = -0.04; x < 0.04; x += 1e-4)
        (void)touch.step(padAt(x, -0.003));
    EXPECT_EQ(allocationsOnThisThread(), before);
}

} // namespace
} // namespace touchstone::test

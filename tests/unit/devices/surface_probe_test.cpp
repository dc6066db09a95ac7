#include "assets/shapes.h"
#include "devices/surface/surface_probe.h"

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace touchstone::surface_probe_test {
namespace {

using Triangles = std::vector<glm::dvec3>; // three corners each

Triangles cornersOf(const assets::Shape& shape) {
    Triangles result;
    for (const uint32_t index : shape.indices)
        result.emplace_back(shape.positions[index]);
    return result;
}

Bounds boundsOf(const Triangles& corners) {
    return boundsOf(trianglesOf(corners));
}

TEST(SurfaceProbe, MeetsTheDiagonalOfAFace) {
    // A cube of 150 mm, seen face-on: the tour crosses its diagonals, and a ray there went straight through.
    const Triangles cube = cornersOf(assets::boxWithSharedCorners(glm::dvec3(0.15)));
    const ProbeView view = viewOf(boundsOf(cube), {0.0, 0.0, 1.0});
    std::vector<glm::dvec2> points;
    for (int i = -1000; i <= 1000; ++i) {
        const double x = 0.0749 * i / 1000.0;
        points.insert(points.end(), {{x, x}, {x, -x}, {x, 0.0}, {0.0, x}});
    }
    for (const auto& hit : probe(trianglesOf(cube), view, points)) {
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->point.z, 0.075, 1e-8); // its corners are floats
        EXPECT_GT(hit->normal.z, 0.999);
    }
}

/// A sphere of 50 mm with a random surface, its triangles slivers here and there; closed to the bit.
Triangles roughBall(std::mt19937& random, double rough) {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const auto below = [&](uint32_t n) { return static_cast<uint32_t>(random() % n); };
    assets::Shape shape = assets::sphere(0.05, 3 + below(20), 3 + below(20));
    for (glm::vec3& p : shape.positions)
        p *= static_cast<float>(1.0 - rough * unit(random));
    const double size = std::pow(10.0, 6.0 * unit(random) - 3.0);
    const glm::dquat turn =
        glm::normalize(glm::dquat(unit(random), unit(random), unit(random), unit(random)));
    const glm::dvec3 move(unit(random), 10.0 * unit(random), -unit(random));
    Triangles corners = cornersOf(shape);
    const bool turned = below(2) == 0;
    for (glm::dvec3& p : corners)
        p = turned ? size * (turn * p + move) : size * p;
    return corners;
}

TEST(SurfaceProbe, NothingSlipsThroughEdgesAndVertices) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    size_t rays = 0;
    for (int trial = 0; trial < 300; ++trial) {
        SCOPED_TRACE(trial);
        const bool convex = trial % 3 == 0;
        const Triangles ball = roughBall(random, convex ? 0.0 : 0.8);
        const glm::dvec3 front = trial % 2 == 0
                                     ? glm::dvec3(0, 0, 1)
                                     : glm::normalize(glm::dvec3(unit(random), unit(random), unit(random)));
        const Bounds bounds = boundsOf(ball);
        const ProbeView view = viewOf(bounds, front);
        std::vector<glm::dvec2> points;
        std::vector<double> heights; // of the place on the surface that the ray goes through
        const auto aim = [&](const glm::dvec3& p) {
            points.emplace_back(view.viewed(p));
            heights.push_back(view.viewed(p).z);
        };
        for (size_t i = 0; i + 2 < ball.size(); i += 3)
            for (size_t k = 0; k < 3; ++k) {
                const glm::dvec3 &a = ball[i + k], &b = ball[i + (k + 1) % 3];
                aim(a);
                aim(0.5 * (a + b));
                aim(glm::mix(a, b, unit(random)));
            }
        // Inside the outline for sure: within a quarter of the least radius of the axis.
        double inner = bounds.diagonal();
        const glm::dvec3 centre = bounds.centre();
        for (const glm::dvec3& p : ball)
            inner = std::min(inner, glm::distance(p, centre));
        const auto hits = probe(trianglesOf(ball), view, points);
        for (size_t i = 0; i < points.size(); ++i) {
            if (glm::length(points[i]) > 0.25 * inner)
                continue;
            ++rays;
            ASSERT_TRUE(hits[i]) << points[i].x << ", " << points[i].y;
            if (convex) { // else the ray may miss a fold by its rounding
                EXPECT_GE(view.viewed(hits[i]->point).z, heights[i] - 1e-9 * bounds.diagonal());
            }
        }
    }
    EXPECT_GT(rays, 2000u);
}

/// The unit square as a fan and as random cuts: every place of it is seen whatever the triangles are.
TEST(SurfaceProbe, SliversAndTrianglesSeenEdgeOnLeaveNoGap) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int trial = 0; trial < 200; ++trial) {
        SCOPED_TRACE(trial);
        // Strips between two rows of corners that share their ends; some strips are without any width.
        Triangles square;
        std::vector<double> cuts{0.0, 1.0};
        for (int i = 0; i < 12; ++i) {
            cuts.push_back(unit(random));
            if (i % 3 == 0)
                cuts.push_back(cuts.back()); // a strip of no width
            else if (i % 3 == 1)
                cuts.push_back(std::nextafter(cuts.back(), 2.0)); // and one of a single bit
        }
        std::ranges::sort(cuts);
        const double slope = trial % 2 == 0 ? 0.0 : 0.3;
        const auto corner = [&](double x, double y) { return glm::dvec3(x, y, slope * x - 0.2 * slope * y); };
        for (size_t i = 0; i + 1 < cuts.size(); ++i) {
            const glm::dvec3 a = corner(cuts[i], 0.0), b = corner(cuts[i + 1], 0.0),
                             c = corner(cuts[i + 1], 1.0), d = corner(cuts[i], 1.0);
            square.insert(square.end(), {a, b, c, a, c, d});
        }
        ProbeView view;
        view.half = glm::dvec3(1.0);
        std::vector<glm::dvec2> points;
        for (int i = 0; i < 300; ++i) {
            const double y = unit(random), x = cuts[random() % cuts.size()];
            points.emplace_back(std::clamp(x, 1e-12, 1.0), y);
            points.emplace_back(unit(random), y);
            points.emplace_back(y, y);
        }
        const auto hits = probe(trianglesOf(square), view, points);
        for (size_t i = 0; i < points.size(); ++i) {
            ASSERT_TRUE(hits[i]) << points[i].x << ", " << points[i].y;
            EXPECT_NEAR(hits[i]->point.z, corner(points[i].x, points[i].y).z, 1e-9);
        }
    }
}

TEST(SurfaceProbe, LooksThroughTheBackOfWhatIsFeltFromItsFront) {
    std::vector<SurfaceTriangle> sheets{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}};
    ProbeView view;
    view.half = glm::dvec3(1.0);
    const std::vector<glm::dvec2> middle{{0.0, 0.0}};
    for (const int front : {0, 1, -1}) {
        sheets[0].front = front;
        EXPECT_EQ(probe(trianglesOf(sheets), view, middle)[0].has_value(), front >= 0) << front;
    }
}

} // namespace
} // namespace touchstone::surface_probe_test

// The curve of tactile shading [004 §4.2]: against the paper's equations in long double, over generated
// polylines.

#include "engine/core/error.h"
#include "haptics/finger/polyline.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace touchstone::test {
namespace {

using Points = std::vector<glm::dvec2>;

/// A walk whose edges turn by less than a right angle, to either side, of lengths within a decade; some turn
/// by nothing.
Points anyWalk() {
    const auto turns = *rc::gen::container<std::vector<int>>(rc::gen::inRange(-85, 86));
    const auto count = std::max<size_t>(turns.size(), 2);
    const auto lengths = *rc::gen::container<std::vector<int>>(count + 1, rc::gen::inRange(10, 100));
    Points points{{0.0, 0.0}};
    double heading = 0.0;
    for (size_t i = 0; i <= count; ++i) {
        const double length = 1e-4 * lengths[i];
        points.push_back(points.back() + length * glm::dvec2(std::cos(heading), std::sin(heading)));
        heading += i < turns.size() ? turns[i] * 3.141592653589793 / 180.0 : 0.3;
    }
    return points;
}

TEST(Polyline, NeighbouringPatchesShareTheTangentAtTheMiddleOfTheirEdge) {
    rc::check("the line at the end of a patch is the line at the beginning of the next", [] {
        const Polyline line(anyWalk(), false);
        const auto patches = line.patches();
        for (size_t i = 0; i + 1 < patches.size(); ++i) {
            const auto u = static_cast<double>(i + 1);
            const SurfaceLine before = line.tangent(std::nextafter(u, 0.0)), after = line.tangent(u);
            RC_ASSERT(glm::distance(before.normal, after.normal) < 1e-9);
            RC_ASSERT(std::abs(glm::dot(before.point - after.point, after.normal)) < 1e-9);
            RC_ASSERT(glm::distance(after.normal, line.edge(i + 1).normal) < 1e-9);
        }
    });
}

using Long = glm::vec<2, long double>;
long double crossOf(const Long& a, const Long& b) {
    return a.x * b.y - a.y * b.x;
}
/// Angle of b seen from a, about the origin.
long double angle(const Long& a, const Long& b) {
    return std::atan2(crossOf(a, b), glm::dot(a, b));
}

/// [004 eqs. 3 and 4] with P0 and P4, and t of DESIGN: the edges p0 p2 and p2 p4, the circle through their
/// ends.
long double publishedParameter(const Long& p0, const Long& p2, const Long& p4, const Long& contact) {
    const Long p1 = 0.5L * (p0 + p2), p3 = 0.5L * (p2 + p4);
    const long double twice = 2.0L * crossOf(p2 - p0, p4 - p0);
    const Long a = p2 - p0, b = p4 - p0;
    Long centre =
        p0 + Long(b.y * glm::dot(a, a) - a.y * glm::dot(b, b), a.x * glm::dot(b, b) - b.x * glm::dot(a, a)) /
                 twice;
    const long double inside = crossOf(p2 - p0, p4 - p2); // side of each edge that the other one lies on
    const auto besides = [&](const Long& from, const Long& to) {
        return crossOf(to - from, centre - from) * inside / std::abs(inside) >
               2e-3L * 0.5L * glm::dot(to - from, to - from);
    };
    if (!besides(p0, p2) || !besides(p2, p4))
        centre = 0.5L * (p1 + p3);
    const auto theta = [&](const Long& p) { return angle(p2 - centre, p - centre); };
    const long double sweep = theta(p3) < 0.0L ? -1.0L : 1.0L;
    if (sweep * theta(contact) <= 0.0L) { // on L1
        const long double lambda = (theta(contact) - theta(p0)) / (0.0L - theta(p0));
        const long double atP1 = (theta(p1) - theta(p0)) / (0.0L - theta(p0));
        return (lambda - atP1) / (2.0L * (1.0L - atP1));
    }
    const long double lambda = theta(contact) / theta(p4), atP3 = theta(p3) / theta(p4);
    return 0.5L + lambda / (2.0L * atP3);
}

TEST(Polyline, ProjectsAsTheEquationsSay) {
    rc::check("t of a point beside a vertex is that of equations 3 and 4", [] {
        const double turn =
            *rc::gen::inRange(1, 120) * (*rc::gen::element(-1.0, 1.0)) * 3.141592653589793 / 180.0;
        const double first = 1e-3 * *rc::gen::inRange(1, 50), second = 1e-3 * *rc::gen::inRange(1, 50);
        const double t = 0.01 * *rc::gen::inRange(2, 99);
        const Points points{
            {0.0, 0.0}, {first, 0.0}, {first + second * std::cos(turn), second * std::sin(turn)}};
        const Polyline line(points, false);
        const SurfaceLine tangent = line.tangent(t);
        const Polyline::Patch& patch = line.patches()[0];
        const glm::dvec2 p12 = tangent.point, p23 = patch.p2 + t * (patch.p3 - patch.p2);
        const glm::dvec2 contact = p12 + t * (p23 - p12); // on the curve
        const long double right =
            publishedParameter(Long(points[0]), Long(points[1]), Long(points[2]), Long(contact));
        RC_ASSERT(right > -1e-9L && right < 1.0L + 1e-9L);
        RC_ASSERT(std::abs(static_cast<double>(right) - line.project(0.5, contact)) < 1e-11);
    });
}

TEST(Polyline, AtTheVertexOfEqualEdgesTheTangentIsSquareToTheBisector) {
    const Polyline line(Points{{-0.01, -0.01}, {0.0, 0.0}, {0.01, -0.01}}, false);
    const SurfaceLine tangent = line.tangent(line.project(0.0, {0.0, 0.02}));
    EXPECT_NEAR(tangent.normal.x, 0.0, 1e-15);
    EXPECT_NEAR(tangent.normal.y, 1.0, 1e-15);
    EXPECT_NEAR(tangent.point.y, -0.0025, 1e-15) << "half way between the vertex and the midpoints";
}

TEST(Polyline, AStraightVertexIsTheLimitOfATurn) {
    for (const double along : {0.006, 0.0087, 0.0123, 0.019}) {
        const glm::dvec2 point(along, 1e-4);
        const Polyline straight(Points{{0.0, 0.0}, {0.01, 0.0}, {0.03, 0.0}}, false);
        for (const double turn : {-1.01e-6, 1.01e-6, 1e-5}) {
            const Polyline bent(
                Points{{0.0, 0.0}, {0.01, 0.0}, {0.01 + 0.02 * std::cos(turn), 0.02 * std::sin(turn)}},
                false);
            EXPECT_NEAR(bent.project(0.5, point), straight.project(0.5, point), 2.0 * std::abs(turn));
        }
    }
}

TEST(Polyline, RefusesWhatHasNoCurve) {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    const std::vector<std::pair<Points, std::string>> bad{
        {{}, "0 places"},
        {{{1.0, 1.0}}, "1 places"},
        {{{1.0, 1.0}, {1.0, 1.0}, {1.0, 1.0}}, "1 places"},
        {{{0.0, 0.0}, {kNaN, 0.0}}, "point 1 is not a place"},
        {{{0.0, 0.0}, {1e160, 0.0}, {1e160, 1e160}}, "point 1 is not a place"},
        {{{0.0, 0.0}, {1.0, 0.0}, {0.5, 0.0}}, "turns back on itself at point 1"}};
    for (const auto& [points, problem] : bad)
        try {
            const Polyline line(points, false);
            ADD_FAILURE() << problem;
        } catch (const Error& error) {
            EXPECT_NE(error.problem().find(problem), std::string::npos) << error.problem();
            EXPECT_FALSE(error.remedy().empty());
        }
    EXPECT_THROW(Polyline(Points{{0.0, 0.0}, {1.0, 0.0}, {0.0, 0.0}}, true), Error) << "two places";
}

TEST(Polyline, PointsAtOnePlaceCountOnce) {
    const Polyline twice(Points{{0.0, 0.0}, {0.01, 0.0}, {0.01, 0.0}, {0.02, 0.01}, {0.02, 0.01}}, false);
    EXPECT_EQ(twice.points().size(), 3u);
    EXPECT_EQ(twice.patches().size(), 1u);
    const Polyline ring(Points{{0.0, 0.0}, {0.0, 1.0}, {1.0, 1.0}, {1.0, 0.0}, {0.0, 0.0}}, true);
    EXPECT_EQ(ring.points().size(), 4u);
    EXPECT_EQ(ring.patches().size(), 4u);
}

} // namespace
} // namespace touchstone::test

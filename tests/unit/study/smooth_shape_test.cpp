// The smooth shapes' closed forms: against a search by numbers, and against the oracle on ever finer meshes.

#include "study/subject/subject.h"
#include "study/truth/truth_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace touchstone::study::smooth_shape_test {
namespace {

using truth::LVec3;
using truth::SmoothShapePtr;

/// Least distance of `p` from a surface of two parameters: a grid around `middle` that closes in on its best
/// place.
long double minDistance(const std::function<LVec3(long double, long double)>& at, const LVec3& p,
                        glm::dvec2 middle, glm::dvec2 half) {
    constexpr int kCells = 40;
    long double least = INFINITY;
    for (int round = 0; round < 60; ++round) {
        glm::dvec2 best = middle;
        for (int i = -kCells; i <= kCells; ++i)
            for (int k = -kCells; k <= kCells; ++k) {
                const glm::dvec2 q = middle + half * glm::dvec2(i, k) / static_cast<double>(kCells);
                const long double d = glm::length(at(q.x, q.y) - p);
                if (d < least) {
                    least = d;
                    best = q;
                }
            }
        middle = best;
        half *= 0.5;
    }
    return least;
}

struct Parametric {
    const char* name;
    SmoothShapePtr shape;
    std::function<LVec3(long double, long double)> at;
    LVec3 hip;
    glm::dvec2 middle, half;
};

std::vector<Parametric> parametricShapes() {
    const auto ball = [](long double a, long double b) {
        return 0.05L * LVec3(std::cos(a) * std::cos(b), std::sin(b), std::sin(a) * std::cos(b));
    };
    const auto rod = [](long double a, long double y) {
        return LVec3(0.025L * std::cos(a), y, 0.025L * std::sin(a));
    };
    const auto ring = [](long double a, long double v) {
        const long double out = 0.06L + 0.025L * std::cos(v);
        return LVec3(out * std::cos(a), out * std::sin(a), 0.025L * std::sin(v));
    };
    const auto waves = [](long double x, long double z) {
        return LVec3(x, 1e-3L * std::cos(2.0L * 3.14159265358979323846L / 0.02L * x), z);
    };
    return {{"sphere", truth::smoothSphere(0.05), ball, {0.03L, 0.02L, -0.031L}, {-0.8, 0.4}, {0.5, 0.5}},
            {"cylinder", truth::smoothCylinder(0.025), rod, {0.02L, 0.01L, 0.012L}, {0.5, 0.0}, {0.5, 0.05}},
            {"torus", truth::smoothTorus(0.06, 0.025), ring, {0.05L, 0.06L, 0.012L}, {0.9, 0.8}, {0.6, 0.8}},
            {"waves",
             truth::smoothWaves(1e-3, 0.02),
             waves,
             {0.0031L, -1e-3L, 0.02L},
             {0.003, 0.02},
             {0.004, 0.01}}};
}

TEST(SmoothShape, RestsWhereASearchFindsTheNearestPlace) {
    for (const Parametric& p : parametricShapes())
        for (const long double radius : {0.0L, 0.5e-3L}) {
            const truth::SmoothRest rest = p.shape->rest(p.hip, radius, p.hip);
            ASSERT_TRUE(rest.contact) << p.name;
            EXPECT_NEAR(static_cast<double>(glm::length(rest.normal)), 1.0, 1e-17) << p.name;
            // The centre is `radius` beyond the nearest place of the surface, straight away from the HIP.
            const long double depth = glm::length(rest.proxy - p.hip) - radius;
            const long double least = minDistance(p.at, p.hip, p.middle, p.half);
            EXPECT_NEAR(static_cast<double>(depth), static_cast<double>(least), 1e-13) << p.name;
            const LVec3 way = (rest.proxy - p.hip) / glm::length(rest.proxy - p.hip);
            EXPECT_LT(static_cast<double>(glm::length(way - rest.normal)), 1e-13) << p.name;
            const long double clear = minDistance(p.at, rest.proxy, p.middle, p.half);
            EXPECT_NEAR(static_cast<double>(clear), static_cast<double>(radius), 1e-13) << p.name;
        }
}

TEST(SmoothShape, LeavesAHandInTheOpenAlone) {
    for (const Parametric& p : parametricShapes()) {
        const truth::SmoothRest in = p.shape->rest(p.hip, 0.0L, p.hip);
        const LVec3 out = in.proxy + 2e-3L * in.normal;
        const truth::SmoothRest free = p.shape->rest(out, 1e-3L, p.hip);
        EXPECT_FALSE(free.contact) << p.name;
        EXPECT_EQ(free.proxy, out) << p.name;
        EXPECT_TRUE(p.shape->rest(out, 3e-3L, out).contact) << p.name;
    }
}

/// A nearer place behind the crest is no place to jump to.
TEST(SmoothShape, OnTheWavesItStaysOnItsFlankUntilThatLetsGo) {
    constexpr double kLength = 0.02, kAmplitude = 4e-3; // steep enough for two rests
    const SmoothShapePtr shape = truth::smoothWaves(kAmplitude, kLength);
    LVec3 last(-0.004L, 3e-3L, 0.0L);
    const LVec3 deep(0.0005L, -2e-3L, 0.0L); // under the crest, a little nearer to the right flank
    const truth::SmoothRest left =
        shape->rest(deep, 0.0L, shape->rest({-0.004L, -1e-3L, 0.0L}, 0.0L, last).proxy);
    const truth::SmoothRest right = shape->rest(deep, 0.0L, {0.004L, 1e-3L, 0.0L});
    EXPECT_LT(left.proxy.x, 0.0L);
    EXPECT_GT(right.proxy.x, 0.0L);
    EXPECT_GT(glm::length(left.proxy - deep), glm::length(right.proxy - deep));
}

std::vector<glm::dvec3> hipsOf(const Subject& subject, size_t ticks) {
    std::vector<glm::dvec3> hips;
    for (size_t i = 0; i < ticks; ++i)
        hips.push_back(subject.hand(1e-3 * static_cast<double>(i)));
    return hips;
}

double furthestApart(const truth::RestPath& a, const truth::RestPath& b) {
    double most = 0.0;
    for (size_t i = 0; i < a.proxies.size(); ++i)
        most = std::max(most, glm::length(a.proxies[i] - b.proxies[i]));
    return most;
}

const ShapeKind& kindNamed(std::string_view name) {
    return *std::find_if(shapeKinds().begin(), shapeKinds().end(),
                         [&](const ShapeKind& kind) { return kind.name == name; });
}

constexpr size_t kWork = 1'000'000'000;

/// What is flat is the same as a mesh: two programs that share nothing must agree, at the ridge too.
TEST(SmoothShape, OfFlatFacesIsWhereTheOracleRestsOnThem) {
    for (const char* name : {"plane", "wedge"}) {
        const ShapeKind& kind = kindNamed(name);
        const Subject subject = kind.make(kind.triangles);
        const std::vector<glm::dvec3> hips = hipsOf(subject, 1500);
        for (const double radius : {0.0, 0.5e-3}) {
            const truth::RestPath smooth = truth::smoothPath(*subject.smooth, hips, radius);
            const truth::RestPath oracle = truth::oraclePath(*subject.bench.haptic, 0, hips, radius, kWork);
            // A point is as thick as half of what was welded, and vertices are floats.
            EXPECT_LT(furthestApart(smooth, oracle), 2e-7) << name << ", radius " << radius;
            EXPECT_EQ(std::count(oracle.failed.begin(), oracle.failed.end(), true), 0) << name;
        }
    }
}

/// Where chords are halved, facets lean half as much, and so goes the proxy aside; their sag falls by four,
/// and so does the depth.
TEST(SmoothShape, OfWhatIsRoundIsWhereTheOraclesOnFinerMeshesTend) {
    for (const char* name : {"sphere", "cylinder", "torus", "waves"}) {
        const ShapeKind& kind = kindNamed(name);
        double asideBefore = 0.0, depthBefore = 0.0;
        for (const size_t triangles : {size_t{20'000}, size_t{80'000}}) {
            const Subject subject = kind.make(triangles);
            const std::vector<glm::dvec3> hips = hipsOf(subject, 600);
            const truth::RestPath smooth = truth::smoothPath(*subject.smooth, hips, 0.5e-3);
            const truth::RestPath oracle = truth::oraclePath(*subject.bench.haptic, 0, hips, 0.5e-3, kWork);
            double depth = 0.0;
            for (size_t i = 0; i < hips.size(); ++i)
                depth = std::max(depth, std::fabs(glm::length(smooth.proxies[i] - hips[i]) -
                                                  glm::length(oracle.proxies[i] - hips[i])));
            const double aside = furthestApart(smooth, oracle);
            EXPECT_GT(aside, 1e-7) << name;
            EXPECT_LT(aside, 1e-4) << name;
            if (asideBefore > 0.0) {
                EXPECT_NEAR(asideBefore / aside, 2.0, 0.3) << name;
                EXPECT_NEAR(depthBefore / depth, 4.0, 0.6) << name;
            }
            asideBefore = aside;
            depthBefore = depth;
        }
    }
}

TEST(SpringForces, PullToTheProxyAndRubAgainstItsWay) {
    const SmoothShapePtr plane = truth::smoothPlane();
    std::vector<glm::dvec3> hips;
    for (int i = 0; i < 10; ++i)
        hips.emplace_back(1e-4 * i, i < 2 ? 1e-3 : -1e-3, 0.0);
    const truth::RestPath rests = truth::smoothPath(*plane, hips, 0.0);
    const std::vector<truth::FeltTick> ticks = truth::springForces(rests, hips, 600.0, 0.3);
    EXPECT_FALSE(ticks[1].contact);
    EXPECT_EQ(ticks[1].force, glm::dvec3(0.0));
    EXPECT_NEAR(ticks[5].force.y, 0.6, 1e-15);
    EXPECT_NEAR(ticks[5].force.x, -0.18, 1e-15);
    EXPECT_NEAR(ticks[5].proxy.x, 5e-4 - 3e-4, 1e-18);
    EXPECT_NEAR(truth::springForces(rests, hips, 600.0, 0.0)[5].force.x, 0.0, 1e-18);
}

TEST(BumpForces, PushAsALiftedSurfaceWould) {
    const SmoothShapePtr plane = truth::smoothPlane();
    std::vector<glm::dvec3> hips{{0.0, 1e-3, 0.0}, {0.0, -1e-3, 0.0}, {0.0, -1e-4, 0.0}};
    const truth::RestPath rests = truth::smoothPath(*plane, hips, 0.0);
    const auto slope = [](const glm::dvec3&) { return truth::BumpAt{2e-4, glm::dvec3(0.75, 0.0, 0.0)}; };
    const std::vector<truth::FeltTick> ticks = truth::reliefForces(rests, hips, 0.0, 1000.0, slope);
    EXPECT_EQ(ticks[0].force, glm::dvec3(0.0));
    // m is (-0.6, 0.8, 0): 0.8 N along n and 0.2 N along m; above the bump height all of it along m.
    EXPECT_NEAR(glm::length(ticks[1].force - glm::dvec3(-0.12, 0.96, 0.0)), 0.0, 1e-15);
    EXPECT_NEAR(glm::length(ticks[2].force - glm::dvec3(-0.06, 0.08, 0.0)), 0.0, 1e-15);
}

TEST(OraclePath, SaysWhereItsWorkRanOut) {
    const Subject subject = kindNamed("plane").make(2);
    const std::vector<glm::dvec3> hips = hipsOf(subject, 400);
    const truth::RestPath path = truth::oraclePath(*subject.bench.haptic, 0, hips, 0.0, 700);
    EXPECT_FALSE(path.failed.front());
    EXPECT_TRUE(path.failed.back());
}

} // namespace
} // namespace touchstone::study::smooth_shape_test

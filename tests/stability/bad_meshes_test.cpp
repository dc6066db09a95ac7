// Meshes as they come: triangles without area, cracks, T-junctions, slivers, inverted windings,
// self-intersections, and every scale.

#include "tests/stability/trial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace touchstone::test {
namespace {

/// A square sheet of 0.1 m, `cells` * `cells`, facing +y, whose vertex at a grid point is `at(i, k)`; each
/// triangle has its own corners.
template <class At>
assets::Shape grid(int cells, At at) {
    std::vector<glm::dvec3> corners;
    for (int i = 0; i < cells; ++i)
        for (int k = 0; k < cells; ++k)
            addQuad(corners, at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k));
    return soup(corners);
}
glm::dvec3 flat(int i, int k, int cells) {
    return {0.1 * i / cells - 0.05, 0.0, 0.1 * k / cells - 0.05};
}

/// Runs a stroke 1 mm deep over the sheet along and across its edges; true if the hand stayed above all
/// along.
bool holdsStrokes(const Scene& scene, const Variant& v, double speed, double largestJump, std::string& why) {
    TouchBench bench(scene, v.settings());
    Gauge gauge;
    double lowest = 1.0;
    const auto take = [&](const HapticOutput& out) {
        gauge.take(out);
        lowest = std::min(lowest, out.proxy.y);
    };
    bench.step({0.03, 0.02, 0.03});
    for (const glm::dvec3& to : {glm::dvec3(0.03, -0.001, 0.03),
                                 {-0.03, -0.001, 0.03},
                                 {-0.03, -0.001, -0.03},
                                 {0.02, -0.001, -0.03},
                                 {0.0, -0.001, 0.0},
                                 {0.0, -0.001, 0.04},
                                 {0.0, 0.02, 0.04}})
        bench.moveTo(to, speed, take);
    const Measured& m = gauge.measured();
    why = "lowest " + std::to_string(lowest) + " jump " + std::to_string(m.largestJump) + " budget " +
          std::to_string(m.budgetReached) + " NaN " + std::to_string(m.notFinite) + " energy " +
          std::to_string(m.energy);
    return lowest > -1e-6 && m.notFinite == 0 && m.largestJump <= largestJump && bench.output.contacts == 0;
}

TEST(BadMeshes, FourHundredTrianglesWithoutAreaChangeNothing) {
    assets::Shape shape = grid(10, [](int i, int k) { return flat(i, k, 10); });
    std::mt19937 random(1);
    std::uniform_real_distribution<double> in(-0.05, 0.05);
    std::vector<glm::dvec3> corners;
    for (int i = 0; i < 400; ++i) {
        const glm::dvec3 a(in(random), 0.0, in(random)), b(in(random), 0.0, in(random));
        switch (i % 3) {
        case 0:
            corners.insert(corners.end(), {a, a, a});
            break;
        case 1:
            corners.insert(corners.end(), {a, b, b});
            break;
        default:
            corners.insert(corners.end(), {a, 0.5 * (a + b), b});
        }
    }
    append(shape, soup(corners));
    std::string why;
    for (const Variant& v : allVariants())
        for (const double speed : allSpeeds())
            EXPECT_TRUE(holdsStrokes(sceneOf(shape), v, speed, 1e-3, why))
                << v.name() << " " << speed << " m/s: " << why;
}

TEST(BadMeshes, DuplicatedAndJitteredVerticesLeaveNoCrack) {
    std::string why;
    for (const double jitter : {0.0, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6}) {
        std::mt19937 random(4);
        std::uniform_real_distribution<double> in(-1.0, 1.0);
        const assets::Shape shape = grid(20, [&](int i, int k) {
            return flat(i, k, 20) + jitter * glm::dvec3(in(random), in(random), in(random));
        });
        const Scene scene = sceneOf(shape);
        const double diagonal = 0.1 * std::sqrt(2.0);
        for (const Variant& v : allVariants()) {
            // A gap wider than the weld tolerance and than the proxy may let it through: that is the
            // geometry's doing. Two corners of one grid point stand up to 2 sqrt(3) jitter apart.
            const double gap = 2.0 * std::sqrt(3.0) * jitter;
            if (gap > kWeldTolerance * diagonal && gap > 2.0 * v.radius)
                continue;
            // What such facets allow: tilts of up to 4 jitter over a cell turn the force, and a sphere climbs
            // the step between two corners of one grid point, `gap` high, over a chord of sqrt(2 r gap).
            const double allowed = 1000.0 * (0.001 + v.radius) * 8.0 * jitter / 0.005 +
                                   1000.0 * std::sqrt(2.0 * v.radius * gap) + 1e-3;
            for (const double speed : allSpeeds())
                EXPECT_TRUE(holdsStrokes(scene, v, speed, allowed, why))
                    << "jitter " << jitter << " " << v.name() << " " << speed << " m/s: " << why;
        }
    }
}

TEST(BadMeshes, TJunctionsHold) {
    std::string why;
    for (const double gap : {0.0, 1e-7, 1e-6}) {
        // The left half has its edge in one piece, the right half in eight whose inner corners stand off by
        // `gap`.
        std::vector<glm::dvec3> corners;
        addQuad(corners, {-0.05, 0, -0.05}, {-0.05, 0, 0.05}, {0, 0, 0.05}, {0, 0, -0.05});
        for (int k = 0; k < 8; ++k) {
            const double z0 = -0.05 + 0.0125 * k, z1 = z0 + 0.0125;
            const double x0 = k == 0 ? 0.0 : gap, x1 = k == 7 ? 0.0 : gap;
            addQuad(corners, {x0, 0, z0}, {x1, 0, z1}, {0.05, 0, z1}, {0.05, 0, z0});
        }
        const Scene scene = sceneOf(soup(corners));
        for (const Variant& v : allVariants()) {
            if (gap > kWeldTolerance * 0.1 * std::sqrt(2.0) && gap > 2.0 * v.radius)
                continue;
            for (const double speed : allSpeeds())
                EXPECT_TRUE(holdsStrokes(scene, v, speed, 1e-3, why))
                    << "gap " << gap << " " << v.name() << " " << speed << " m/s: " << why;
        }
    }
}

TEST(BadMeshes, SliversOfAspectAMillionHold) {
    std::string why;
    // Fans of slivers 0.1 µm wide and 0.1 m long between ordinary triangles.
    std::vector<glm::dvec3> corners;
    double x = -0.05;
    for (int i = 0; i < 20; ++i) {
        addQuad(corners, {x, 0, -0.05}, {x, 0, 0.05}, {x + 1e-7, 0, 0.05}, {x + 1e-7, 0, -0.05});
        addQuad(corners, {x + 1e-7, 0, -0.05}, {x + 1e-7, 0, 0.05}, {x + 0.005, 0, 0.05},
                {x + 0.005, 0, -0.05});
        x += 0.005;
    }
    for (const Variant& v : allVariants())
        for (const double speed : allSpeeds())
            EXPECT_TRUE(holdsStrokes(sceneOf(soup(corners)), v, speed, 1e-3, why))
                << v.name() << " " << speed << " m/s: " << why;
}

TEST(BadMeshes, InvertedAndMixedWindingsAndNonManifoldEdgesHold) {
    std::string why;
    assets::Shape shape = grid(12, [](int i, int k) { return flat(i, k, 12); });
    for (size_t t = 0; t < shape.triangleCount(); t += 3)
        std::swap(shape.indices[3 * t], shape.indices[3 * t + 1]);
    // Fins below the sheet: edges with three and four triangles.
    std::vector<glm::dvec3> corners;
    for (int i = 1; i < 12; ++i) {
        const double x = 0.1 * i / 12 - 0.05;
        addQuad(corners, {x, 0, -0.05}, {x, 0, 0.05}, {x, -0.01, 0.05}, {x, -0.01, -0.05});
    }
    append(shape, soup(corners));
    for (const Variant& v : allVariants())
        for (const double speed : allSpeeds())
            EXPECT_TRUE(holdsStrokes(sceneOf(shape), v, speed, 1e-3, why))
                << v.name() << " " << speed << " m/s: " << why;
}

TEST(BadMeshes, SheetsThatCrossEachOtherHold) {
    // A sheet with a ridge that stands through it: the hand slides up to the ridge and is stopped, never let
    // in.
    assets::Shape shape = grid(6, [](int i, int k) { return flat(i, k, 6); });
    std::vector<glm::dvec3> corners;
    addQuad(corners, {-0.01, -0.02, -0.05}, {-0.01, -0.02, 0.05}, {0.013, 0.02, 0.05}, {0.013, 0.02, -0.05});
    append(shape, soup(corners));
    for (const Variant& v : allVariants())
        for (const double speed : allSpeeds()) {
            SCOPED_TRACE(v.name() + " at " + std::to_string(speed) + " m/s");
            TouchBench bench(sceneOf(shape), v.settings());
            bench.step({-0.03, 0.02, 0.0});
            bench.moveTo({-0.03, -0.001, 0.0}, speed);
            bench.moveTo({0.04, -0.001, 0.0}, speed);
            EXPECT_GT(bench.output.proxy.y, -1e-6);
            EXPECT_LT(bench.output.proxy.x, 0.013 + 1e-6);
            EXPECT_LT(holdStill(bench, 100), 1e-9);
        }
}

TEST(BadMeshes, EveryScaleFeelsTheSame) {
    // The sphere of 1800 triangles at 1e-6 .. 1e3 m and at offsets of 1e6 m, the hand scaled along.
    std::vector<glm::dvec3> reference;
    for (const double scale : {1.0, 1e-6, 1e-3, 1e3}) {
        for (const double offset : {0.0, 1e6}) {
            if (offset > 0.0 && scale < 1e-3)
                continue; // the HIP itself, a double, is known to 0.1 nm at 1e6 m
            glm::dmat4 at(scale);
            at[3] = glm::dvec4(offset, 0.0, -offset, 1.0);
            Variant v;
            TouchBench bench(sceneOf(assets::sphere(0.05, 30, 30), at), v.settings());
            const glm::dvec3 origin(offset, 0.0, -offset);
            size_t n = 0;
            bench.step(origin + scale * glm::dvec3(0.08, 0.01, 0.0));
            for (int i = 0; i < 400; ++i) {
                const double a = 2e-3 * i;
                bench.step(origin + scale * 0.049 *
                                        glm::normalize(glm::dvec3(std::cos(a), 0.2 + 0.1 * a, std::sin(a))));
                const glm::dvec3 proxy = (bench.output.proxy - origin) / scale;
                if (scale == 1.0 && offset == 0.0)
                    reference.push_back(proxy);
                // Positions at 1e6 m are good to 1e-10 m; the rounding of float vertices differs between
                // frames.
                else
                    EXPECT_LT(glm::length(proxy - reference[n]), 1e-6 * 0.17 + 1e-9 / scale)
                        << "scale " << scale << " offset " << offset << " tick " << i;
                ++n;
            }
        }
    }
}

} // namespace
} // namespace touchstone::test

// Meshes as they come: triangles without area, cracks, T-junctions, slivers, inverted windings,
// self-intersections, and every scale.

#include "tests/stability/hard_case.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace touchstone::test::bad_meshes_test {
namespace {

/// A square sheet of 0.1 m, `cells` * `cells`, facing +y, whose vertex at a grid point is `at(i, k)`; each
/// cell has its own corners.
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

/// Strokes 1 mm deep over a sheet in y = 0, along and across its edges, with a hold, and back.
void strokeOver(HardCase& run, double speed) {
    run.startAt({0.03, 0.02, 0.03});
    run.moveTo({0.03, -0.001, 0.03}, speed);
    run.moveTo({-0.03, -0.001, 0.03}, speed);
    run.moveTo({-0.03, -0.001, -0.03}, speed);
    run.moveTo({0.02, -0.001, -0.03}, speed);
    run.moveTo({0.0, -0.001, 0.0}, speed);
    run.hold(30);
    run.moveTo({0.0, -0.001, 0.04}, speed);
    run.moveTo({0.0, 0.02, 0.04}, speed);
    run.moveTo({0.03, 0.02, 0.03}, speed);
    run.judge();
}

/// `roughness`: m, how far the mesh's vertices stand below y = 0 at most; `gap`: m, its widest.
void strokeAtAllSpeeds(const std::string& name, const assets::Shape& shape, double roughness, double gap) {
    for (const Variant& v : allVariants())
        for (const double speed : allSpeeds()) {
            SCOPED_TRACE(name + " " + v.name() + " at " + std::to_string(speed) + " m/s");
            const Scene scene = sceneFor(shape, v);
            const HardCase probe(name, scene, v);
            // A gap wider than the weld tolerance and than the proxy may let it through: the geometry's
            // doing.
            const double weld = kWeldTolerance * glm::length(glm::dvec2(0.1));
            const bool open = gap > weld && gap > 2.0 * probe.effectiveRadius();
            HardCase run(open ? name + ", wider than the weld and 2 r" : name, scene, v);
            run.side([roughness](const glm::dvec3& p) { return p.y + roughness; }, open ? INFINITY : 0.0);
            strokeOver(run, speed);
        }
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
    strokeAtAllSpeeds("400 triangles without area", shape, 0.0, 0.0);
}

TEST(BadMeshes, DuplicatedAndJitteredVerticesLeaveNoCrack) {
    for (const double jitter : {0.0, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6}) {
        std::mt19937 random(4);
        std::uniform_real_distribution<double> in(-1.0, 1.0);
        const assets::Shape shape = grid(20, [&](int i, int k) {
            return flat(i, k, 20) + jitter * glm::dvec3(in(random), in(random), in(random));
        });
        // Two corners of one grid point stand up to 2 sqrt(3) jitter apart.
        char name[64];
        std::snprintf(name, sizeof name, "vertices jittered by %g m", jitter);
        strokeAtAllSpeeds(name, shape, jitter, 2.0 * std::sqrt(3.0) * jitter);
    }
}

TEST(BadMeshes, TJunctionsHold) {
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
        char name[64];
        std::snprintf(name, sizeof name, "T-junctions, gap %g µm", gap * 1e6);
        strokeAtAllSpeeds(name, soup(corners), 0.0, gap);
    }
}

TEST(BadMeshes, SliversOfAspectAMillionHold) {
    // Caps: the middle of a sliver's long edge is drawn 0.1 µm to the side, and the next cell starts from
    // there. All corners are far from each other, so no weld takes them away.
    std::vector<glm::dvec3> corners;
    for (int i = 0; i < 20; ++i) {
        const double x = -0.05 + 0.005 * i;
        const glm::dvec3 a(x, 0, -0.05), b(x, 0, 0.05), c(x + 0.005, 0, 0.05), d(x + 0.005, 0, -0.05);
        const glm::dvec3 m(x + 1e-7, 0, 0.0);
        corners.insert(corners.end(), {a, b, m, m, b, c, m, c, d, m, d, a});
    }
    strokeAtAllSpeeds("slivers of aspect 1e6", soup(corners), 0.0, 0.0);
}

TEST(BadMeshes, InvertedAndMixedWindingsAndNonManifoldEdgesHold) {
    assets::Shape inverted = grid(12, [](int i, int k) { return flat(i, k, 12); });
    for (size_t t = 0; t < inverted.triangleCount(); ++t)
        std::swap(inverted.indices[3 * t], inverted.indices[3 * t + 1]);
    strokeAtAllSpeeds("inverted windings", inverted, 0.0, 0.0);
    assets::Shape shape = grid(12, [](int i, int k) { return flat(i, k, 12); });
    for (size_t t = 0; t < shape.triangleCount(); t += 3)
        std::swap(shape.indices[3 * t], shape.indices[3 * t + 1]);
    strokeAtAllSpeeds("mixed windings", shape, 0.0, 0.0);
    // Fins below the sheet: edges with three and four triangles.
    std::vector<glm::dvec3> corners;
    for (int i = 1; i < 12; ++i) {
        const double x = 0.1 * i / 12 - 0.05;
        addQuad(corners, {x, 0, -0.05}, {x, 0, 0.05}, {x, -0.01, 0.05}, {x, -0.01, -0.05});
    }
    append(shape, soup(corners));
    strokeAtAllSpeeds("non-manifold edges, mixed windings", shape, 0.0, 0.0);
}

TEST(BadMeshes, SheetsThatCrossEachOtherHold) {
    // A sheet with another that stands through it: the hand slides up to that and is stopped, never let in.
    assets::Shape shape = grid(6, [](int i, int k) { return flat(i, k, 6); });
    std::vector<glm::dvec3> corners;
    addQuad(corners, {-0.01, -0.02, -0.05}, {-0.01, -0.02, 0.05}, {0.013, 0.02, 0.05}, {0.013, 0.02, -0.05});
    append(shape, soup(corners));
    const glm::dvec3 across = glm::normalize(glm::dvec3(-0.04, 0.023, 0.0));
    for (const Variant& v : allVariants())
        for (const double speed : allSpeeds()) {
            SCOPED_TRACE(v.name() + " at " + std::to_string(speed) + " m/s");
            HardCase run("self-intersection", sceneFor(shape, v), v);
            run.side([across](const glm::dvec3& p) {
                return std::min(p.y, glm::dot(across, p - glm::dvec3(0.0015, 0.0, 0.0)));
            });
            run.startAt({-0.03, 0.015, 0.0});
            run.moveTo({-0.03, -0.001, 0.0}, speed);
            run.moveTo({0.04, -0.001, 0.01}, speed);
            run.hold();
            run.leave(speed);
        }
}

TEST(BadMeshes, EveryScaleHoldsTheSame) {
    // A sphere of 1800 triangles at 1e-6 .. 1e3 of its 0.1 m; hand, speed and radius scaled along.
    for (const double scale : {1e-6, 1e-3, 1.0, 1e3})
        for (const Variant& chosen : allVariants())
            for (const double speed : allSpeeds()) {
                SCOPED_TRACE("scale " + std::to_string(scale) + " " + chosen.name() + " at " +
                             std::to_string(speed) + " m/s");
                const Variant v{chosen.radius * scale, chosen.shaded};
                assets::Shape sphere = assets::sphere(0.05, 30, 30);
                if (!v.shaded)
                    sphere.normals.clear();
                char name[32];
                std::snprintf(name, sizeof name, "sphere, scale %g", scale);
                HardCase run(name, sceneOf(sphere, glm::dmat4(glm::dmat3(scale))), v);
                // Outside of the sphere inscribed in all facets: 30 steps of 12 and of 6 degrees.
                const double inner = 0.05 * scale * std::cos(0.10472) * std::cos(0.05236);
                run.side([inner](const glm::dvec3& p) { return glm::length(p) - inner; });
                const auto at = [scale](double r, double a) {
                    return scale * r * glm::normalize(glm::dvec3(std::cos(a), 0.2 + 0.1 * a, std::sin(a)));
                };
                run.startAt(at(0.08, 0.0));
                run.moveTo(at(0.049, 0.1), speed * scale);
                run.moveTo(at(0.049, 0.4), speed * scale);
                run.hold(30);
                run.moveTo(at(0.0485, 0.6), speed * scale);
                run.leave(speed * scale);
            }
}

TEST(BadMeshes, EveryPlaceFeelsTheSame) {
    // The sphere of 1800 triangles at offsets of 1e6 m, and at every scale, against itself at the origin.
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
} // namespace touchstone::test::bad_meshes_test

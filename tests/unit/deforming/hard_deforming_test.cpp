// Hard cases: vertices faster than the hand, triangles that collapse and invert, a figure that closes on the
// hand, jumps, publications farther apart than ticks, and closer.
#include "tests/unit/deforming/deforming_bench.h"

#include <random>

namespace touchstone::test::hard_deforming_test {
namespace {

/// A box of `cells` x 1 x `cells` cells around the origin, closed, m.
MorphCase boxCase(const glm::dvec3& half, int cells = 4) {
    MorphCase made;
    const auto face = [&](const glm::dvec3& centre, const glm::dvec3& u, const glm::dvec3& v) {
        const auto first = static_cast<uint32_t>(made.positions.size());
        for (int j = 0; j <= cells; ++j)
            for (int i = 0; i <= cells; ++i)
                made.positions.emplace_back(centre + (2.0 * i / cells - 1.0) * u +
                                            (2.0 * j / cells - 1.0) * v);
        for (int j = 0; j < cells; ++j)
            for (int i = 0; i < cells; ++i) {
                const auto a = first + static_cast<uint32_t>(j * (cells + 1) + i), b = a + 1;
                const auto c = a + static_cast<uint32_t>(cells + 1), d = c + 1;
                for (const uint32_t index : {a, b, d, a, d, c})
                    made.indices.push_back(index);
            }
    };
    const glm::dvec3 x(half.x, 0, 0), y(0, half.y, 0), z(0, 0, half.z);
    face(x, y, z);
    face(-x, z, y);
    face(y, z, x);
    face(-y, x, z);
    face(z, x, y);
    face(-z, y, x);
    return made;
}

template <class Displace>
void addTarget(MorphCase& made, const Displace& displace) {
    std::vector<glm::vec3>& target = made.targets.emplace_back();
    for (const glm::vec3& p : made.positions)
        target.emplace_back(displace(glm::dvec3(p)));
}

HapticSettings with(double radius, double friction = 0.0) {
    HapticSettings settings;
    settings.proxyRadius = radius;
    settings.staticFriction = settings.dynamicFriction = friction;
    return settings;
}

/// A wall that shoots past a resting hand at up to 10 m/s pushes it along and never lets it through.
TEST(HardDeforming, AFastWallTakesTheHandAlong) {
    for (const double radius : {0.0, 0.002})
        for (const float seconds : {0.5f, 0.05f, 0.01f}) {
            MorphCase wall = boxCase({0.05, 0.01, 0.05});
            addTarget(wall, [](const glm::dvec3&) { return glm::dvec3(0.0, 0.1, 0.0); });
            wall.times = {0.0f, 0.2f, 0.2f + seconds, 0.4f + seconds, 0.4f + 2 * seconds};
            wall.weights = {0, 0, 1, 1, 0};
            DeformingBench bench(sceneOfMorph(wall), with(radius));
            const glm::dvec3 hip = bench.haptic->workspaceFromScene.point({0.003, 0.02, 0.002});
            double highest = -1.0;
            for (int k = 0; k < 1000; ++k) {
                const HapticOutput& output = bench.tick(hip, 1e-3 * k);
                highest = std::max(highest, bench.haptic->workspaceFromScene.inversePoint(output.proxy).y);
            }
            EXPECT_GT(highest, 0.105) << "the wall passed the hand";
            EXPECT_EQ(bench.report.starts, 1u);
            expectExact(bench.report, "wall in " + std::to_string(seconds) + " s, radius " +
                                          std::to_string(1e3 * radius) + " mm");
        }
}

/// The box collapses to a sheet and turns inside out around its middle, under a pressing and a beside hand.
TEST(HardDeforming, TrianglesCollapseAndInvert) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (const double radius : {0.0, 0.002})
        for (int way = 0; way < 3; ++way) {
            MorphCase made = boxCase({0.05, 0.02, 0.05}, 6);
            addTarget(made, [&](const glm::dvec3& p) {
                return way == 0   ? glm::dvec3(0.0, -p.y, 0.0)               // a sheet
                       : way == 1 ? glm::dvec3(-2.0 * p.x, 0.0, 0.0)         // inside out
                                  : glm::dvec3(-p.x, -p.y, -p.z) * 0.999999; // a point, almost
            });
            made.times = {0.0f, 0.5f, 1.0f};
            made.weights = {0, 1, 0};
            DeformingBench bench(sceneOfMorph(made), with(radius, 0.3));
            bench.closed = way == 0;
            glm::dvec3 hip(0.0, 0.05, 0.0), to = hip;
            for (int k = 0; k < 4000; ++k) {
                if (k % 100 == 0)
                    to = glm::dvec3(0.06 * unit(random), 0.04 * unit(random), 0.06 * unit(random));
                hip += 0.03 * (to - hip);
                bench.tick(hip, 1e-3 * k);
            }
            EXPECT_GT(bench.report.contacts, 100u);
            EXPECT_LT(bench.report.deepest, 2e-12L) << way;
            EXPECT_LE(bench.report.overLimit, 1e-9);
            std::printf("way %d, radius %.0f mm: %zu in contact, %zu jams, %zu starts, clearance %+.1Le\n",
                        way, 1e3 * radius, bench.report.contacts, bench.report.jams, bench.report.starts,
                        -bench.report.deepest);
        }
}

/// Two jaws of one mesh close on the hand: it is let go of, with the flag, and touches again when they open
/// and it has left. Nothing passes before.
TEST(HardDeforming, AFigureThatClosesOnTheHandLetsItGo) {
    MorphCase jaws = boxCase({0.05, 0.01, 0.05});
    MorphCase upper = jaws;
    for (glm::vec3& p : jaws.positions)
        p.y -= 0.03f;
    const auto first = static_cast<uint32_t>(jaws.positions.size());
    for (const glm::vec3& p : upper.positions)
        jaws.positions.push_back(p + glm::vec3(0.0f, 0.03f, 0.0f));
    for (const uint32_t index : upper.indices)
        jaws.indices.push_back(first + index);
    addTarget(jaws, [](const glm::dvec3& p) { return glm::dvec3(0.0, p.y > 0.0 ? -0.0199 : 0.0199, 0.0); });
    jaws.times = {0.0f, 0.5f, 0.7f, 1.0f};
    jaws.weights = {0, 1, 1, 0};
    DeformingBench bench(sceneOfMorph(jaws), with(0.004));
    for (int k = 0; k < 1000; ++k)
        bench.tick(bench.haptic->workspaceFromScene.point({0.0, 0.001, 0.0}), 1e-3 * k);
    EXPECT_GT(bench.report.jams, 0u);
    EXPECT_GT(bench.report.contacts, 10u);
    expectExact(bench.report, "jaws");
    EXPECT_FALSE(bench.hand.state.placed) << "it begins again only away from the model";
    for (int k = 1000; k < 1100; ++k)
        bench.tick({0.0, 0.0, 0.2}, 1e-3 * k);
    EXPECT_TRUE(bench.hand.state.placed);
}

/// Ticks much longer than publications, and much shorter.
TEST(HardDeforming, AnyTickIsExact) {
    for (const double dt : {2e-2, 7e-3, 1e-3, 2.5e-4}) {
        MorphCase made = boxCase({0.05, 0.02, 0.05}, 5);
        addTarget(made,
                  [](const glm::dvec3& p) { return glm::dvec3(0.2 * p.z, 0.02 + 0.3 * p.x, -0.2 * p.y); });
        made.times = {0.0f, 0.4f, 0.8f};
        made.weights = {0, 1, 0};
        DeformingBench bench(sceneOfMorph(made), with(0.001, 0.5));
        const glm::dvec3 hip = bench.haptic->workspaceFromScene.point({0.01, 0.024, 0.004});
        for (int k = 0; k < 1200; ++k)
            bench.tick(hip, dt * k, dt);
        EXPECT_GT(bench.report.contacts, 100u);
        expectExact(bench.report, "dt " + std::to_string(1e3 * dt) + " ms");
    }
}

/// An animation that ends elsewhere than it begins: the vertices jump, as an object's pose does.
TEST(HardDeforming, ALapThatEndsElsewhereJumps) {
    MorphCase made = boxCase({0.05, 0.01, 0.05});
    addTarget(made, [](const glm::dvec3&) { return glm::dvec3(0.0, 0.05, 0.0); });
    made.times = {0.0f, 0.5f};
    made.weights = {0, 1};
    DeformingBench bench(sceneOfMorph(made), with(0.001));
    size_t jumped = 0;
    for (int k = 0; k < 2000; ++k)
        jumped += has(bench.tick(bench.haptic->workspaceFromScene.point({0.0, 0.03, 0.0}), 1e-3 * k).flags,
                      TickFlag::ObjectJumped)
                      ? 1
                      : 0;
    EXPECT_EQ(jumped, 3u);
    expectExact(bench.report, "laps");
}

} // namespace
} // namespace touchstone::test::hard_deforming_test

// The geometry of the hard cases, felt as meshes and as distance fields: what each holds, and what a field
// cannot hold because it is smaller than a voxel (docs/architecture.md, Shapes).

#include "haptics/shape/field/field_shape.h"
#include "tests/stability/trial.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>

namespace touchstone::test::field_cases_test {
namespace {

constexpr double kRadian = 3.141592653589793 / 180.0;

/// A geometry and a path of the hand, back to where it starts.
struct Row {
    std::string name;
    assets::Shape shape;
    double voxel = 0.0; ///< m, of the field
    /// m, how far a place stands on the side where the hand starts; in closed form.
    std::function<double(const glm::dvec3&)> outside;
    std::vector<glm::dvec3> way; ///< from free space; the last place is held
    /// Voxels by which a field may stand behind `outside`: it rounds edges.
    double rounds = 0.0;
    /// Voxels by which the held proxy stands before the surface of the mesh; more says what is lost.
    double before = 0.0;
};

assets::Shape inverted(assets::Shape shape, size_t every) {
    for (size_t t = 0; t < shape.triangleCount(); t += every)
        std::swap(shape.indices[3 * t], shape.indices[3 * t + 1]);
    shape.normals.clear();
    return shape;
}

assets::Shape plates(double thickness) {
    assets::Shape all;
    for (int i = 0; i < 10; ++i) {
        glm::dmat4 at(1.0);
        at[3] = glm::dvec4(0.0, -0.002 * i, 0.0, 1.0);
        append(all, assets::box({0.1, thickness, 0.1}, 2), at);
    }
    return all;
}

assets::Shape openGroove(double degrees) {
    const double x = 0.06 * std::sin(0.5 * degrees * kRadian), y = 0.06 * std::cos(0.5 * degrees * kRadian);
    std::vector<glm::dvec3> corners;
    addQuad(corners, {0, 0, -0.05}, {0, 0, 0.05}, {x, y, 0.05}, {x, y, -0.05});
    addQuad(corners, {-x, y, -0.05}, {-x, y, 0.05}, {0, 0, 0.05}, {0, 0, -0.05});
    return soup(corners);
}

/// A box with a second one that stands through it.
assets::Shape crossed() {
    assets::Shape all = assets::box({0.1, 0.02, 0.1}, 3);
    glm::dmat4 at(1.0);
    at[3] = glm::dvec4(0.02, 0.01, 0.0, 1.0);
    append(all, assets::box({0.01, 0.04, 0.1}, 2), at);
    return all;
}

/// 400 triangles without area in the plane of a box's upper face.
assets::Shape withoutArea() {
    assets::Shape all = assets::box({0.1, 0.02, 0.1}, 4);
    std::vector<glm::dvec3> corners;
    for (int i = 0; i < 400; ++i) {
        const glm::dvec3 a(0.0002 * i - 0.04, 0.01, 0.03 * std::sin(i)), b(a.x, 0.01, a.z + 0.01);
        if (i % 2 == 0)
            corners.insert(corners.end(), {a, a, a});
        else
            corners.insert(corners.end(), {a, 0.5 * (a + b), b});
    }
    append(all, soup(corners));
    return all;
}

double above(const glm::dvec3& p, double y) {
    return p.y - y;
}

/// Presses at one place, strokes to another; the last place is held.
std::vector<glm::dvec3> stroke(double top, double depth) {
    return {{0.011, top + 0.03, 0.007}, {0.011, top - depth, 0.007}, {-0.02, top - depth, -0.03}};
}

std::vector<Row> held() {
    std::vector<Row> rows;
    const auto add = [&](Row row) { rows.push_back(std::move(row)); };
    const auto top = [](double y) { return [y](const glm::dvec3& p) { return above(p, y); }; };
    add({"plate 1 mm, pressed 3 mm", assets::box({0.1, 0.001, 0.1}, 4), 0.0005, top(0.0005),
         stroke(0.0005, 0.003)});
    add({"the same, by the usual voxel", assets::box({0.1, 0.001, 0.1}, 4), 0.0, top(0.0), // its middle
         stroke(0.0005, 0.003)});
    add({"open sheet, from above", assets::plane(0.1, 0.1, 5, 5), 0.001, top(0.0), stroke(0.0, 0.003)});
    add({"open sheet, from below",
         assets::plane(0.1, 0.1, 5, 5),
         0.001,
         [](const glm::dvec3& p) { return -p.y; },
         {{0.011, -0.03, 0.007}, {0.011, 0.003, 0.007}, {-0.02, 0.003, -0.03}}});
    add({"ten plates of 0.5 mm",
         plates(0.0005),
         0.00025,
         top(0.00025),
         {{0.011, 0.05, 0.007}, {0.011, -0.05, 0.007}}});
    add({"a cube's edge",
         assets::box(glm::dvec3(0.1), 3),
         0.001,
         [](const glm::dvec3& p) {
             const glm::dvec3 out = glm::abs(p) - glm::dvec3(0.05);
             return std::max({out.x, out.y, out.z});
         },
         {{0.06, 0.06, 0.003}, {0.049, 0.0495, 0.003}, {0.0495, 0.049, -0.01}},
         1.0});
    add({"inverted windings", inverted(assets::box({0.1, 0.02, 0.1}, 4), 1), 0.001, top(0.01),
         stroke(0.01, 0.003)});
    add({"mixed windings", inverted(assets::box({0.1, 0.02, 0.1}, 4), 3), 0.001, top(0.01),
         stroke(0.01, 0.003)});
    add({"400 triangles without area", withoutArea(), 0.001, top(0.01), stroke(0.01, 0.003)});
    add({"a box through a box",
         crossed(),
         0.001,
         [](const glm::dvec3& p) { return std::min(p.y - 0.01, 0.015 - p.x); },
         {{-0.03, 0.03, 0.0}, {-0.03, 0.009, 0.0}, {0.03, 0.009, 0.01}},
         0.6});
    add({"groove 20°",
         openGroove(20.0),
         0.001,
         [](const glm::dvec3& p) {
             return p.y * std::sin(10.0 * kRadian) - std::abs(p.x) * std::cos(10.0 * kRadian);
         },
         {{0.0, 0.08, 0.01}, {0.0005, -0.01, 0.01}, {-0.002, -0.01, -0.02}}});
    return rows;
}

/// What is smaller than a voxel.
std::vector<Row> lost() {
    std::vector<Row> rows;
    for (const double voxel : {0.0007, 0.0009, 0.0011, 0.0013, 0.0015, 0.0017})
        rows.push_back({"ten plates of 0.5 mm, voxels of " + std::to_string(1e3 * voxel).substr(0, 3) + " mm",
                        plates(0.0005),
                        voxel,
                        [](const glm::dvec3& p) { return above(p, 0.00025); },
                        {{0.011, 0.05, 0.007}, {0.011, -0.05, 0.007}}});
    std::vector<glm::dvec3> needle;
    for (int i = 0; i < 16; ++i) {
        const double a = 22.5 * kRadian * i, b = a + 22.5 * kRadian;
        const glm::dvec3 p(0.002 * std::cos(a), -0.04, 0.002 * std::sin(a)),
            q(0.002 * std::cos(b), -0.04, 0.002 * std::sin(b));
        needle.insert(needle.end(), {{0, 0, 0}, q, p, {0, -0.04, 0}, p, q});
    }
    rows.push_back({"a needle's tip, 1:20, voxels of 0.5 mm",
                    soup(needle),
                    0.0005,
                    [](const glm::dvec3& p) { return p.y + 0.04; },
                    {{2e-5, 0.02, 0.0}, {2e-5, -0.001, 0.0}}});
    rows.push_back({"groove 5°, voxels of 1 mm",
                    openGroove(5.0),
                    0.001,
                    [](const glm::dvec3& p) {
                        return p.y * std::sin(2.5 * kRadian) - std::abs(p.x) * std::cos(2.5 * kRadian);
                    },
                    {{0.0, 0.08, 0.01}, {0.0005, -0.01, 0.01}}});
    return rows;
}

struct Judged {
    double behind = -INFINITY; ///< m, farthest behind Row::outside
    double jitter = 0.0, jump = 0.0, energy = 0.0, energyAllowed = 0.0, hold = 0.0; ///< N, N, J, J, m
    int notFinite = 0, late = 0, ticks = 0, contacts = 0;
    double command = 0.0; ///< N, most
    glm::dvec3 proxy{0.0};
    double firstTouch = NAN; ///< m, height of the hand
    bool freeAgain = false;
};

std::shared_ptr<const HapticScene> compiled(const Row& row, bool field) {
    Scene scene = sceneOf(row.shape);
    scene.materials[0].haptic.implicit = field;
    scene.materials[0].haptic.voxelSize = field ? static_cast<float>(row.voxel) : 0.0f;
    auto haptic = compileHapticScene(scene, Similarity{});
    EXPECT_EQ(haptic->objects[0]->shape != nullptr, field);
    return haptic;
}

/// Along the way, a hold, and back.
Judged judge(const Row& row, const std::shared_ptr<const HapticScene>& scene, double radius, double speed) {
    constexpr double kSpring = 1000.0;
    TouchBench bench(sceneOf(assets::plane(0.1, 0.1)), Variant{radius, false}.settings());
    bench.scene = scene; // of one object, too
    Gauge gauge(kSpring);
    Judged judged;
    HapticOutput last;
    const auto take = [&](const HapticOutput& now) {
        gauge.take(now);
        judged.behind = std::max(judged.behind, -row.outside(now.proxy));
        judged.late += has(now.flags, TickFlag::BudgetReached) ? 1 : 0;
        judged.command = std::max(judged.command, glm::length(now.commandInWorkspace));
        if (judged.ticks++ > 0) {
            const double travel = glm::distance(now.hip, last.hip);
            const double jump = std::max(0.0, glm::distance(now.force, last.force) - kSpring * travel);
            // hard_case.h: the trapezium rule's error where planes come and go, and where the force jumps.
            judged.energyAllowed += kSpring * travel * travel / 8.0 + 0.5 * jump * travel;
        }
        if (now.contacts > 0 && std::isnan(judged.firstTouch))
            judged.firstTouch = now.hip.y;
        last = now;
    };
    take(bench.step(row.way.front()));
    for (size_t i = 1; i < row.way.size(); ++i)
        bench.moveTo(row.way[i], speed, take);
    for (int i = 0; i < 40; ++i)
        take(bench.step(row.way.back()));
    const glm::dvec3 settled = bench.output.proxy;
    glm::dvec3 force = bench.output.force;
    for (int i = 0; i < 60; ++i) {
        take(bench.step(row.way.back()));
        judged.jitter = std::max(judged.jitter, glm::distance(bench.output.force, force));
        force = bench.output.force;
    }
    judged.hold = glm::distance(settled, bench.output.proxy);
    judged.proxy = bench.output.proxy;
    judged.contacts = static_cast<int>(bench.output.contacts);
    for (size_t i = row.way.size() - 1; i-- > 0;)
        bench.moveTo(row.way[i], speed, take);
    judged.freeAgain = bench.output.contacts == 0;
    judged.notFinite = gauge.measured().notFinite;
    judged.jump = gauge.measured().largestJump;
    judged.energy = gauge.measured().energy;
    return judged;
}

struct AsMesh {
    static constexpr bool kField = false;
};
struct AsField {
    static constexpr bool kField = true;
};

template <class Shape>
class HardGeometry : public ::testing::Test {};
using Shapes = ::testing::Types<AsMesh, AsField>;
TYPED_TEST_SUITE(HardGeometry, Shapes);

TYPED_TEST(HardGeometry, IsHeldAtEverySpeedAndLetsGo) {
    constexpr bool kField = TypeParam::kField;
    for (const Row& row : held()) {
        Judged worst;
        const auto scene = compiled(row, kField);
        const double voxel = row.voxel > 0.0 ? row.voxel : 0.1 / 128.0;
        for (const double radius : {0.0, 0.5e-3})
            for (const double speed : allSpeeds()) {
                SCOPED_TRACE(row.name + (kField ? ", field, r " : ", mesh, r ") + std::to_string(radius) +
                             " at " + std::to_string(speed) + " m/s");
                const Judged judged = judge(row, scene, radius, speed);
                const double allowed = kField ? row.rounds * voxel + 0.02 * voxel : 1e-8;
                EXPECT_LE(judged.behind, allowed) << "passes through";
                EXPECT_EQ(judged.notFinite, 0);
                EXPECT_GT(judged.contacts, 0);
                EXPECT_LE(judged.command, DeviceLimits{}.maxForce * (1.0 + 1e-9));
                EXPECT_LE(judged.jitter, 1e-4) << "jitters while held, N";
                EXPECT_LE(judged.hold, 1e-7) << "creeps while held, m";
                EXPECT_TRUE(judged.freeAgain);
                EXPECT_LE(judged.energy, judged.energyAllowed + 1e-9) << "energy over the closed path, J";
                worst.behind = std::max(worst.behind, judged.behind);
                worst.jitter = std::max(worst.jitter, judged.jitter);
                worst.hold = std::max(worst.hold, judged.hold);
                worst.jump = std::max(worst.jump, judged.jump);
                worst.energy = std::max(worst.energy, judged.energy);
                worst.late += judged.late;
                worst.ticks += judged.ticks;
            }
        std::printf("| %s | %s | %.3g | %.2g | %.2g | %.2g | %.2g | %d of %d |\n", row.name.c_str(),
                    kField ? "field" : "mesh", 1e3 * worst.behind, 1e6 * worst.jitter, 1e6 * worst.hold,
                    worst.jump, 1e6 * worst.energy, worst.late, worst.ticks);
    }
}

/// What a field makes of walls thinner, and of gaps narrower, than a voxel is off by a number; the mesh has
/// them as they are. Nothing is ever not finite.
TEST(HardGeometry, WhatIsSmallerThanAVoxelIsLost) {
    double platesOff = 0.0;
    for (const Row& row : lost()) {
        SCOPED_TRACE(row.name);
        const Judged mesh = judge(row, compiled(row, false), 0.0, 0.05),
                     field = judge(row, compiled(row, true), 0.0, 0.05);
        std::printf("%s: touched at y = %.3f mm and held at %.3f mm on the mesh; %.3f and %.3f mm on the "
                    "field\n",
                    row.name.c_str(), 1e3 * mesh.firstTouch, 1e3 * mesh.proxy.y, 1e3 * field.firstTouch,
                    1e3 * field.proxy.y);
        EXPECT_EQ(field.notFinite + mesh.notFinite, 0);
        EXPECT_LE(field.command, DeviceLimits{}.maxForce * (1.0 + 1e-9));
        if (row.name.starts_with("ten plates")) {
            EXPECT_NEAR(mesh.proxy.y, 0.00025, 1e-7);
            platesOff = std::max(platesOff, mesh.proxy.y - field.proxy.y);
        } else if (row.name.starts_with("groove")) {
            // Walls that are open sheets are shells, a voxel each: they meet at voxel / sin(2.5°).
            EXPECT_NEAR(mesh.proxy.y, 0.0, 1e-5);
            EXPECT_GT(field.proxy.y, row.voxel / std::sin(2.5 * kRadian));
        } else {
            EXPECT_LT(mesh.firstTouch - field.firstTouch, row.voxel) << "the tip of the needle";
        }
    }
    EXPECT_GT(platesOff, 0.00049) << "a plate thinner than a voxel is felt at its other side";
}

} // namespace
} // namespace touchstone::test::field_cases_test

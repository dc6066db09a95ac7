// Where several planes hold the hand each contact carries its own load: against closed forms, through the
// whole tick.

#include "haptics/force/contact_loads.h"
#include "haptics/force/spring_damper.h"
#include "tests/support/corner.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace touchstone::test::loads_test {
namespace {

constexpr double kPi = 3.141592653589793, kRadius = kCornerRadius;

TEST(Loads, AGrooveOfTwoStiffnessesGivesOneContinuousForce) {
    for (const auto& [left, right] : {std::pair{300.0f, 900.0f}, std::pair{900.0f, 300.0f}}) {
        const std::vector<Wall> walls = groove(0.5 * kPi, left, right);
        TouchBench bench(cornerScene(walls), cornerSettings());
        const Corner corner = cornerOf(*bench.scene);
        const std::vector<glm::dvec3>& normals = corner.normals;
        bench.step({0.0, 0.01, 0.0});
        const double bottom = kRadius / std::sin(0.25 * kPi); // where the centre of the ball comes to
        bench.moveTo({-1e-5, bottom - 0.003, 0.0}, 0.05);
        glm::dvec3 last = bench.output.force;
        for (int i = -1000; i <= 1000; ++i) {
            const glm::dvec3 hip(1e-8 * i, bottom - 0.003, 0.0);
            const glm::dvec3 force = bench.step(hip).force;
            EXPECT_LT(glm::distance(force, elasticOf(normals, walls, solveCorner(corner, kRadius, hip))),
                      1e-9);
            EXPECT_LE(glm::distance(force, last), 900.0 * 1e-8 + 1e-12);
            last = force;
        }
        // 3 mm below the line each wall carries 3 / sqrt(2) mm.
        EXPECT_NEAR(last.y, 0.5 * (300.0 + 900.0) * 0.003, 0.01);
        EXPECT_NEAR(std::abs(last.x), 0.5 * (900.0 - 300.0) * 0.003, 0.01);
    }
}

TEST(Loads, FrictionAlongAGrooveIsCoulombOnTheWallsOwnLoads) {
    struct Case {
        double angle, friction; // rad, N for a resultant of 1 N
    };
    for (const Case along :
         {Case{0.5 * kPi, 0.5 / std::sin(0.25 * kPi)}, Case{kPi / 9.0, 0.5 / std::sin(kPi / 18.0)}})
        for (const FrictionMode law : {FrictionMode::Zilles, FrictionMode::Ho, FrictionMode::Elastoplastic}) {
            std::vector<Wall> walls = groove(along.angle, 500.0f, 500.0f);
            for (Wall& wall : walls)
                wall.staticFriction = wall.dynamicFriction = 0.5f;
            HapticSettings s = cornerSettings();
            s.friction = law;
            TouchBench bench(cornerScene(walls), s);
            const double y = kRadius / std::sin(0.5 * along.angle) - 0.002;
            bench.step({0.0, 0.01, -0.1});
            bench.moveTo({0.0, y, -0.1}, 0.05);
            bench.moveTo({0.0, y, 0.1}, 0.1);
            EXPECT_NEAR(bench.output.force.y, 1.0, 1e-5);
            EXPECT_EQ(bench.output.friction, FrictionState::Sliding);
            EXPECT_NEAR(-bench.output.force.z, along.friction, 1e-4) << settingValue(s, "friction");
        }
}

/// The lateral faces of a prism seen from inside, with the normals of the cylinder round it.
assets::Shape pipe(uint32_t sides, double radius, double length) {
    assets::Shape shape;
    for (uint32_t i = 0; i < sides; ++i)
        for (const double y : {-0.5 * length, 0.5 * length}) {
            const double a = 2.0 * kPi * i / sides;
            shape.positions.emplace_back(radius * std::cos(a), y, radius * std::sin(a));
            shape.normals.emplace_back(-std::cos(a), 0.0, -std::sin(a));
        }
    for (uint32_t i = 0; i < sides; ++i) {
        const uint32_t a = 2 * i, b = 2 * ((i + 1) % sides);
        for (const uint32_t k : {a, b, a + 1, b, b + 1, a + 1})
            shape.indices.push_back(k);
    }
    return shape;
}

TEST(Loads, EachContactInAPipeIsTurnedToItsOwnNormal) {
    const double radius = 0.1, depth = 1.05e-3;
    for (const ShadingMode mode : {ShadingMode::Direction, ShadingMode::Projected, ShadingMode::TwoPass}) {
        HapticSettings s = cornerSettings();
        s.forceShading = mode;
        s.stiffness = 1000.0;
        TouchBench bench(sceneOf(pipe(10, radius, 0.3)), s);
        SCOPED_TRACE(settingValue(s, "forceShading"));
        bench.step({0.0, 0.003, 0.0});
        bench.moveTo({radius + depth, 0.003, 0.0}, 0.2);
        glm::dvec3 last = bench.output.force;
        double worst = 0.0, jump = 0.0;
        // So little that it is not felt, and the contacts are told apart.
        bench.settings.damping = 1e-9;
        int several = 0;
        const int ticks = 20000;
        for (int i = 0; i <= ticks; ++i) {
            const double a = 2.0 * kPi * i / ticks;
            const glm::dvec3 out(std::cos(a), 0.0, std::sin(a));
            const glm::dvec3 force = bench.step((radius + depth) * out + glm::dvec3(0, 0.003, 0)).force;
            const DeviceState& state = bench.state[0];
            several += (state.shaded ? state.rest.shadedActiveSet : state.rest.activeSet).count > 1;
            worst = std::max(worst, std::acos(std::min(glm::dot(-out, glm::normalize(force)), 1.0)));
            jump = std::max(jump, glm::distance(force, last));
            last = force;
        }
        EXPECT_GT(several, mode == ShadingMode::TwoPass ? 5 : 100);
        EXPECT_LE(worst * 180.0 / kPi, 0.5);
        EXPECT_LE(jump, 0.02);
        printf("pipe, forceShading=%s: at most %.3f degrees off the radius, %.4f N a tick\n",
               settingValue(s, "forceShading").c_str(), worst * 180.0 / kPi, jump);
    }
}

TEST(Loads, TheViscousTermStaysInsideTheCone) {
    for (const FrictionMode law : {FrictionMode::Zilles, FrictionMode::Ho, FrictionMode::Elastoplastic})
        for (const float viscous : {0.5f, 4.0f}) {
            std::vector<Wall> walls{{.normal = {0, 1, 0}, .stiffness = 600.0f}};
            walls[0].staticFriction = walls[0].dynamicFriction = 0.3f;
            walls[0].viscousFriction = viscous;
            HapticSettings s = cornerSettings();
            s.friction = law;
            TouchBench bench(cornerScene(walls), s);
            bench.step({-0.05, 0.01, 0.0});
            bench.moveTo({-0.05, kRadius - 0.001, 0.0}, 0.05);
            bench.moveTo({0.05, kRadius - 0.001, 0.0}, 0.1);
            EXPECT_NEAR(bench.output.force.y, 0.6, 1e-9);
            EXPECT_NEAR(-bench.output.force.x, 0.18, 1e-5) << settingValue(s, "friction") << ' ' << viscous;
        }
}

TEST(Loads, DampersOfSeveralWallsAddUpAndNeverPull) {
    // At right angles each wall has its damper to itself.
    std::vector<Wall> walls = groove(0.5 * kPi, 400.0f, 800.0f);
    walls[0].damping = 2.0f;
    walls[1].damping = 5.0f;
    TouchBench bench(cornerScene(walls), cornerSettings());
    const Corner corner = cornerOf(*bench.scene);
    const std::vector<glm::dvec3>& normals = corner.normals;
    bench.step({0.0, 0.01, 0.0});
    bench.moveTo({0.0, -0.002, 0.0}, 0.02);
    int clipped = 0, both = 0;
    for (const glm::dvec3 to : {glm::dvec3(0.0, -0.004, 0.0), glm::dvec3(0.0, -2e-5, 0.0)})
        bench.moveTo(to, 0.1, [&](const HapticOutput& out) {
            if (out.planeCount < 2)
                return;
            const CornerSolve solve = solveCorner(corner, kRadius, out.hip);
            glm::dvec3 force = elasticOf(normals, walls, solve);
            for (size_t i = 0; i < 2; ++i) {
                const double push = static_cast<double>(walls[i].stiffness) * solve.load[i];
                const double damping =
                    -static_cast<double>(walls[i].damping) * glm::dot(out.hipVelocity, normals[i]);
                force += std::max(damping, -push) * normals[i];
                clipped += damping < -push;
            }
            ++both;
            EXPECT_LT(glm::distance(out.force, force), 1e-9);
        });
    EXPECT_GT(both, 50);
    EXPECT_GT(clipped, 3);
}

TEST(Loads, AlmostParallelWallsShareOneDamperAndOneViscousTerm) {
    // Two walls of one material, a hundredth of a degree from flat: as one wall feels.
    std::vector<Wall> walls = groove(kPi - 2e-4, 600.0f, 600.0f);
    for (Wall& wall : walls) {
        wall.damping = 3.0f;
        wall.viscousFriction = 2.0f;
    }
    HapticSettings s = cornerSettings();
    s.friction = FrictionMode::Zilles;
    TouchBench bench(cornerScene(walls), s);
    bench.step({0.0, 0.01, -0.05});
    bench.moveTo({0.0, -0.001, -0.05}, 0.05);
    int both = 0;
    bench.moveTo({0.0, -0.003, 0.05}, 0.1, [&](const HapticOutput& out) {
        both += out.planeCount == 2;
        const double press = 600.0 * (kRadius - out.hip.y) - 3.0 * out.hipVelocity.y;
        EXPECT_NEAR(out.force.y, press, 1e-4 * press);
        EXPECT_NEAR(out.force.z, -2.0 * out.hipVelocity.z, 1e-4);
    });
    EXPECT_GT(both, 500);
}

/// Two walls with bump height, whose loads for the HIP `hip` are those of the closed form.
ContactLoads relievedGroove(double angle, const std::array<SurfaceSample, 2>& feels, const glm::dvec3& hip) {
    const Corner corner{{{std::cos(0.5 * angle), std::sin(0.5 * angle), 0.0},
                         {-std::cos(0.5 * angle), std::sin(0.5 * angle), 0.0}},
                        {0.0, 0.0}};
    const CornerSolve solve = solveCorner(corner, 0.0, hip);
    ContactLoads loads;
    loads.offset = solve.place - hip;
    double sum = 0.0, weighted = 0.0;
    for (size_t i = 0; i < 2; ++i) {
        if (!(solve.load[i] > 0.0))
            continue;
        ContactLoad& load = loads.contacts[static_cast<size_t>(loads.count++)];
        load.surface = load.plane = corner.normals[i];
        load.length = solve.load[i];
        load.depth = glm::dot(load.plane, loads.offset);
        load.feel = feels[i];
        load.feel.normal = load.plane;
        load.feel.depth = load.length;
        sum += load.length;
        weighted += load.feel.stiffness * load.length;
    }
    loads.stiffness = sum > 0.0 ? weighted / sum : 0.0;
    return loads;
}

TEST(Loads, ReliefOfSeveralWallsIsContinuousAndThatOfOneWallWhereOneIsLeft) {
    for (const double angle : {0.5, 1.0, 0.5 * kPi, 2.1, 3.0})
        for (const double height : {0.0, 5e-5, 4e-4, 5e-3})
            for (const bool law : {true, false}) {
                SCOPED_TRACE(std::to_string(angle) + " rad, H " + std::to_string(height));
                std::array<SurfaceSample, 2> feels;
                for (size_t i = 0; i < 2; ++i) {
                    const double side = i == 0 ? 1.0 : -1.0, lean = 0.5 * angle + side * 0.35;
                    feels[i].touching = true;
                    feels[i].stiffness = 600.0;
                    feels[i].hasHeight = law;
                    feels[i].height = height;
                    feels[i].textured = {side * std::cos(lean), std::sin(lean), 0.0};
                }
                // Across the groove, from one wall over both to the other.
                glm::dvec3 last(0.0);
                const double step = 2e-7;
                int both = 0;
                for (int i = -60000; i <= 60000; ++i) {
                    const glm::dvec3 hip(step * i, -1e-3, 0.0);
                    const ContactLoads loads = relievedGroove(angle, feels, hip);
                    glm::dvec3 force = elasticForce(loads);
                    if (loads.count == 1) {
                        SurfaceSample one = loads.contacts[0].feel;
                        one.depth = glm::length(loads.offset);
                        const glm::dvec3 alone =
                            springDamperForce(one, glm::dvec3(0.0), glm::dvec3(0.0), glm::dvec3(0.0));
                        EXPECT_LT(glm::distance(force, alone), 1e-9);
                        force = alone;
                    }
                    both += loads.count == 2;
                    if (i > -60000) {
                        // k times the loads' rate sqrt(2) / sigma, and half as much for t_i lambda_i.
                        const double rate =
                            1.5 * 600.0 * std::sqrt(2.0) / std::sqrt(1.0 - std::abs(std::cos(angle)));
                        EXPECT_LE(glm::distance(force, last), rate * step) << "x " << hip.x;
                    }
                    last = force;
                }
                EXPECT_GT(both, 300);
            }
}

TEST(Loads, InACrackTheLoadsAreBounded) {
    // A thousandth of a radian: each wall carries a thousand times the resultant.
    const double angle = 1e-3, depth = 1e-4;
    std::vector<Wall> walls = groove(angle, 300.0f, 900.0f);
    for (Wall& wall : walls)
        wall.staticFriction = wall.dynamicFriction = 0.5f;
    HapticSettings s = cornerSettings();
    s.friction = FrictionMode::Zilles;
    TouchBench bench(cornerScene(walls), s);
    const Corner corner = cornerOf(*bench.scene);
    const double bottom = kRadius / std::sin(0.5 * angle);
    bench.step({0.0, bottom + 0.01, -0.05});
    bench.moveTo({0.0, bottom - depth, -0.05}, 0.05);
    int both = 0;
    bench.moveTo({0.0, bottom - depth, 0.05}, 0.1, [&](const HapticOutput& out) {
        both += out.planeCount == 2;
        const CornerSolve solve = solveCorner(corner, kRadius, out.hip);
        const double resultant = glm::distance(solve.place, out.hip);
        const double sum = solve.load[0] + solve.load[1];
        EXPECT_GT(sum, 50.0 * resultant);
        const double beta = kMaxLoad * resultant / sum;
        glm::dvec3 elastic(0.0);
        double stiffness = 0.0, most = 0.0;
        for (size_t i = 0; i < 2; ++i)
            stiffness += static_cast<double>(walls[i].stiffness) * solve.load[i] / sum;
        elastic = stiffness * (solve.place - out.hip);
        for (size_t i = 0; i < 2; ++i) {
            const double k = static_cast<double>(walls[i].stiffness);
            elastic += beta * (k - stiffness) * solve.load[i] * corner.normals[i];
            most += 0.5 * beta * k * solve.load[i];
        }
        EXPECT_NEAR(out.force.x, elastic.x, 1e-4);
        EXPECT_NEAR(out.force.y, elastic.y, 1e-4);
        EXPECT_LE(std::abs(out.force.z), most * (1.0 + 1e-4));
    });
    EXPECT_GT(both, 500);
    EXPECT_GT(std::abs(bench.output.force.z), 5.0 * 600.0 * depth);
}

TEST(Loads, WithZoomAStifferWallThatJoinsWithoutLoadChangesNothing) {
    // Six times as large: the device bears 3500 / 6 N/m of the workspace's. The softer wall is below that.
    std::vector<Wall> walls = groove(0.5 * kPi, 300.0f, 900.0f);
    TouchBench bench(cornerScene(walls), cornerSettings());
    bench.mapping.workspaceFromDevice.scale = 6.0;
    bench.step({0.0, 0.01 / 6.0, 0.0});
    bench.moveTo({0.001, -0.003 / 6.0, 0.0}, 0.05 / 6.0);
    glm::dvec3 last = bench.output.force;
    double jump = 0.0;
    int both = 0, one = 0;
    const double step = 1e-7;
    for (int i = 10000; i >= -10000; --i) {
        const glm::dvec3 force = bench.step({step * i, -0.003 / 6.0, 0.0}).force;
        both += bench.output.planeCount == 2;
        one += bench.output.planeCount == 1;
        jump = std::max(jump, glm::distance(force, last));
        last = force;
    }
    EXPECT_GT(both, 1000);
    EXPECT_GT(one, 1000);
    EXPECT_LE(jump, 3500.0 / 6.0 * std::sqrt(2.0) * 6.0 * step + 1e-9);
}

TEST(Loads, WhereAMapTakesAllFrictionAwayItTakesTheViscousTermWithIt) {
    // A vertex attribute from 0.5 to nothing along x: the viscous term has no step where the cone closes.
    Scene scene = sceneOf(assets::plane(0.2, 0.2, 2, 2));
    for (const glm::vec3& p : scene.meshes[0].positions)
        scene.meshes[0].friction.push_back(p.x < -0.05f ? 0.5f : 0.0f);
    scene.materials[0].haptic.viscousFriction = {4.0f, HapticSource::Touchstone};
    HapticSettings s = cornerSettings();
    s.friction = FrictionMode::Elastoplastic;
    TouchBench bench(scene, s);
    bench.step({-0.09, 0.01, 0.0});
    bench.moveTo({-0.09, -0.001, 0.0}, 0.05);
    double last = 0.0, jump = 0.0;
    bench.moveTo({0.09, -0.001, 0.0}, 0.1, [&](const HapticOutput& out) {
        if (out.hip.x > -0.05)
            jump = std::max(jump, std::abs(out.force.x - last));
        last = out.force.x;
    });
    EXPECT_LT(jump, 2e-3);
    EXPECT_NEAR(last, 0.0, 1e-9);
}

/// What still steps, and by how much.
TEST(Loads, ABorderOfTwoStiffnessesInOnePlaneStepsByTheDepthTimesTheirDifference) {
    // One wall from x = -0.2 to 0 and one from 0 to 0.2, in the plane y = 0.
    const auto half = [](double side) {
        assets::Shape shape;
        for (const glm::vec3 p : {glm::vec3(0, 0, -0.1), glm::vec3(0, 0, 0.1), glm::vec3(0.2 * side, 0, 0.1),
                                  glm::vec3(0.2 * side, 0, -0.1)})
            shape.positions.push_back(p);
        shape.indices =
            side > 0.0 ? std::vector<uint32_t>{0, 1, 2, 0, 2, 3} : std::vector<uint32_t>{0, 2, 1, 0, 3, 2};
        return shape;
    };
    Scene scene = sceneOf(half(-1.0));
    addShape(scene, half(1.0));
    scene.materials.emplace_back();
    scene.meshes[1].material = 1;
    scene.materials[0].haptic.stiffness = {300.0f, HapticSource::Touchstone};
    scene.materials[1].haptic.stiffness = {900.0f, HapticSource::Touchstone};
    TouchBench bench(scene, cornerSettings());
    bench.step({-0.01, 0.01, 0.0});
    bench.moveTo({-0.01, -0.002, 0.0}, 0.05);
    double last = bench.output.force.y, step = 0.0;
    int steps = 0;
    bench.moveTo({0.01, -0.002, 0.0}, 0.1, [&](const HapticOutput& out) {
        steps += std::abs(out.force.y - last) > 1e-6;
        step = std::max(step, std::abs(out.force.y - last));
        last = out.force.y;
    });
    EXPECT_EQ(steps, 1);
    EXPECT_NEAR(step, (0.002 + kRadius) * (900.0 - 300.0), 1e-9);
}

} // namespace
} // namespace touchstone::test::loads_test

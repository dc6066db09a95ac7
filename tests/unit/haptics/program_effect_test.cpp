// Haptic programs in the tick: force, coefficients, frames, budget, plan and identity.

#include "engine/program/surface_program.h"
#include "haptics/program/program_touch.h"
#include "haptics/recording/scene_identity.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/corner.h"
#include "tests/support/test_shapes.h"
#include "tests/support/touch_bench.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <string>

namespace touchstone::test::program_effect_test {
namespace {

using nlohmann::json;

constexpr double kDepth = 1e-3; // m
/// N: the proxy rests up to 0.1 µm above the surface.
constexpr double kGapForce = 1e-4;

void giveProgram(Material& material, const std::string& body, const json& parameters = json::object(),
                 const std::string& declarations = "") {
    const json shader{{"source", "test.glsl"}, {"parameters", parameters}};
    const auto compiled = compileSurfaceProgram(
        "test.glsl",
        declarations + "void touch(const in Touch before, inout Surface after) {\n" + body + "\n}\n", {},
        [] { return false; });
    material.says.ours.shader = KeptJson(shader);
    material.says.ours.program = compiled;
    material.haptic.program = materialProgram(compiled, shader);
}

/// A square of 0.1 m in the plane z = 0 that faces +z, with texture coordinates.
Scene planeOf(const std::string& body, const json& parameters = json::object(),
              const std::string& declarations = "") {
    Scene scene;
    scene.materials.emplace_back();
    place(scene, quadMesh(0.05, 4), 0);
    giveProgram(scene.materials[0], body, parameters, declarations);
    return scene;
}

/// The force at rest `kDepth` below (x, y) of the plane z = 0.
glm::dvec3 forceAt(TouchBench& bench, double x, double y) {
    bench.step({x, y, 0.002});
    bench.moveTo({x, y, -kDepth}, 0.05);
    for (int i = 0; i < 300; ++i)
        bench.step({x, y, -kDepth});
    return bench.output.force;
}

double stiffnessOf(const TouchBench& bench) {
    return bench.limits.recommendedStiffness;
}

TEST(ProgramEffect, AProgramThatLeavesAllAloneIsThePlainSurface) {
    TouchBench bench(planeOf("after.staticFriction = before.staticFriction;"));
    ASSERT_TRUE(bench.scene->plan.programs);
    const glm::dvec3 force = forceAt(bench, 0.01, 0.003);
    EXPECT_NEAR(force.z, stiffnessOf(bench) * kDepth, kGapForce);
    EXPECT_NEAR(glm::length(glm::dvec2(force)), 0.0, 1e-6);
    EXPECT_EQ(bench.output.flags & (0u | TickFlag::ProgramFailed), 0u);
}

TEST(ProgramEffect, AChangedStiffnessScalesTheForceThatIsReturned) {
    TouchBench bench(planeOf("after.stiffness = 0.5 * before.stiffness; after.force = 1.25 * before.force;"));
    EXPECT_NEAR(forceAt(bench, 0.0, 0.0).z, 0.5 * 1.25 * stiffnessOf(bench) * kDepth, kGapForce);
}

TEST(ProgramEffect, NoStiffnessIsAboveWhatTheDeviceBears) {
    TouchBench bench(planeOf("after.stiffness = 1e30;"));
    EXPECT_NEAR(forceAt(bench, 0.0, 0.0).z, bench.limits.maxStiffness * kDepth, 5.0 * kGapForce);
}

TEST(ProgramEffect, ADisplacementHasItsClosedFormWithEachGradient) {
    constexpr double kHeight = 1e-4, kWave = 1256.0;
    for (const char* mode : {"dual", "central"}) {
        TouchBench bench(planeOf("after.position.z += height * sin(1256.0 * before.position.x);",
                                 {{"height", kHeight}}, "parameter float height = 0.0; // 0..0.001 m\n"));
        ASSERT_EQ(setSetting(bench.settings, "programs", mode), "");
        for (int i = 0; i < 20; ++i) {
            const double x = -0.01 + 0.00107 * i;
            const glm::dvec3 force = forceAt(bench, x, 0.001);
            const double h = kHeight * std::sin(kWave * x), slope = kHeight * kWave * std::cos(kWave * x);
            const double push = stiffnessOf(bench) * (kDepth + h);
            EXPECT_NEAR(force.z, push, kGapForce) << mode << x;
            EXPECT_NEAR(force.x, -push * slope, 2e-4) << mode << x;
        }
    }
}

TEST(ProgramEffect, WithoutAGradientADisplacementChangesTheDepthAloneAndOffThereIsNone) {
    TouchBench bench(planeOf("after.position.z += 2e-4 * sin(1256.0 * before.position.x);"));
    ASSERT_EQ(setSetting(bench.settings, "programs", "noGradient"), "");
    const glm::dvec3 flat = forceAt(bench, 0.0101, 0.0);
    EXPECT_EQ(flat.x, 0.0);
    EXPECT_NEAR(flat.z, stiffnessOf(bench) * (kDepth + 2e-4 * std::sin(1256.0 * 0.0101)), kGapForce);
    ASSERT_EQ(setSetting(bench.settings, "programs", "off"), "");
    EXPECT_NEAR(forceAt(bench, 0.0101, 0.0).z, stiffnessOf(bench) * kDepth, kGapForce);
}

TEST(ProgramEffect, ItsCoefficientsHoldTheHandAndLetItSlide) {
    TouchBench bench(planeOf("after.staticFriction = 0.6; after.dynamicFriction = 0.25;"));
    forceAt(bench, 0.0, 0.0);
    double greatest = 0.0, leastAfter = 1.0;
    bool slid = false;
    bench.moveTo({0.02, 0.0, -kDepth}, 0.02, [&](const HapticOutput& out) {
        const double ratio = -out.force.x / out.force.z;
        greatest = std::max(greatest, ratio);
        slid |= out.friction == FrictionState::Sliding;
        if (slid)
            leastAfter = std::min(leastAfter, ratio);
    });
    EXPECT_TRUE(slid);
    EXPECT_NEAR(greatest, 0.6, 0.03);
    EXPECT_NEAR(leastAfter, 0.25, 0.03) << "the sawtooth falls to the dynamic coefficient";
    ASSERT_EQ(setSetting(bench.settings, "friction", "off"), "");
    bench.moveTo({0.0, 0.0, -kDepth}, 0.02);
    EXPECT_NEAR(bench.output.force.x, 0.0, 1e-6);
}

/// What a program reads, told by its stiffness: k' = 400 N/m + 100 N/m times the number.
double readAt(const Scene& scene, const glm::dvec3& place, const glm::dvec3& normal) {
    TouchBench bench(scene);
    bench.limits.maxStiffness = 1e4;
    bench.step(place + 0.002 * normal);
    bench.moveTo(place - kDepth * normal, 0.05);
    for (int i = 0; i < 300; ++i)
        bench.step(place - kDepth * normal);
    return (glm::dot(bench.output.force, normal) / bench.output.penetration - 400.0) / 100.0;
}

TEST(ProgramEffect, PlacesAndDirectionsAreThoseOfTheMeshUnderATurnedScaledAndMovedNode) {
    const auto read = [](const std::string& what, const glm::dmat4& pose, const glm::dvec3& inMesh) {
        Scene scene =
            planeOf("after.stiffness = 400.0 + 100.0 * float(" + what + "); after.force = before.force;");
        scene.instances[0].sceneFromMesh = pose;
        const glm::dvec3 normal = glm::normalize(glm::dmat3(pose) * glm::dvec3(0.0, 0.0, 1.0));
        return readAt(scene, glm::dvec3(pose * glm::dvec4(inMesh, 1.0)), normal);
    };
    glm::dmat4 pose = glm::translate(glm::dmat4(1.0), {0.3, -0.2, 0.1});
    pose = glm::rotate(pose, 0.7, glm::normalize(glm::dvec3(1.0, 2.0, -0.5)));
    pose = glm::scale(pose, glm::dvec3(2.0));
    const glm::dvec3 at(0.013, -0.007, 0.0);
    // Metres of the scene: twice those of the mesh.
    EXPECT_NEAR(read("100.0 * before.position.x", pose, at), 2.6, 1e-3);
    EXPECT_NEAR(read("100.0 * before.position.y", pose, at), -1.4, 1e-3);
    EXPECT_NEAR(read("100.0 * before.position.z", pose, at), 0.0, 1e-3);
    EXPECT_NEAR(read("before.normal.z", pose, at), 1.0, 1e-5);
    EXPECT_NEAR(read("before.tangent.x", pose, at), 1.0, 1e-5);
    EXPECT_NEAR(read("before.binormal.y", pose, at), 1.0, 1e-5);
    // The square is 0.1 m wide; v runs downwards.
    EXPECT_NEAR(read("before.uv.x", pose, at), 0.5 + 0.13, 1e-4);
    EXPECT_NEAR(read("before.uv.y", pose, at), 0.5 + 0.07, 1e-4);
    EXPECT_NEAR(read("length(before.force)", pose, at), 0.6 * 1.0, 0.6);
}

TEST(ProgramEffect, TheToolsMotionIsTheHands) {
    // Along x at 0.05 m/s, frictionless.
    const auto sliding = [](const std::string& what) {
        TouchBench bench(planeOf("after.stiffness = 400.0 + 100.0 * float(" + what + ");"));
        bench.limits.maxStiffness = 1e4;
        bench.step({-0.02, 0.0, 0.002});
        bench.moveTo({-0.02, 0.0, -kDepth}, 0.05);
        bench.moveTo({0.02, 0.0, -kDepth}, 0.05);
        return (bench.output.force.z / bench.output.penetration - 400.0) / 100.0;
    };
    EXPECT_NEAR(sliding("before.toolDirection.x"), 1.0, 1e-5);
    EXPECT_NEAR(sliding("10.0 * before.toolVelocity.x"), 0.5, 1e-4);
    EXPECT_NEAR(sliding("before.toolAcceleration.x"), 0.0, 1e-3);
    EXPECT_NEAR(sliding("1e4 * before.filterWidth"), 0.5, 1e-4);
    EXPECT_NEAR(sliding("before.time"), 0.86, 0.01);
    // At rest the direction is that of the last motion.
    TouchBench bench(planeOf("after.stiffness = 400.0 + 100.0 * before.toolDirection.y;"));
    bench.step({0.0, -0.02, 0.002});
    bench.moveTo({0.0, -0.02, -kDepth}, 0.05);
    EXPECT_NEAR(bench.output.force.z / bench.output.penetration, 400.0, 1e-2)
        << "none before any motion along the surface";
    bench.moveTo({0.0, 0.02, -kDepth}, 0.05);
    for (int i = 0; i < 1000; ++i)
        bench.step({0.0, 0.02, -kDepth});
    EXPECT_NEAR(bench.output.force.z / bench.output.penetration, 500.0, 1e-2);
}

TEST(ProgramEffect, ARunWithoutAResultIsFlaggedAndItsSurfacePlain) {
    for (const char* body :
         {"after.force = before.force / (before.uv.x * 0.0);", "after.stiffness = sqrt(-before.stiffness);",
          "int n = int(before.stiffness); float sum = 0.0; for (int i = 0; i < n * 1000; ++i) sum += "
          "sin(float(i)); "
          "after.force *= sum;",
          "int zero = int(before.uv.x) - int(before.uv.x); after.force *= float(7 / zero);",
          "float a[3] = float[3](1.0, 2.0, 3.0); after.force *= a[int(before.stiffness)];"}) {
        TouchBench bench(planeOf(body));
        ASSERT_TRUE(bench.scene->plan.programs) << body;
        const glm::dvec3 force = forceAt(bench, 0.01, 0.003);
        EXPECT_NEAR(force.z, stiffnessOf(bench) * kDepth, kGapForce) << body;
        EXPECT_TRUE(has(bench.output.flags, TickFlag::ProgramFailed)) << body;
    }
}

TEST(ProgramEffect, AnythingReturnedStaysInsideItsBounds) {
    for (const char* body : {"after.force = -1e30 * before.force;", "after.position += 1e30 * before.normal;",
                             "after.position -= vec3(1e3); after.normal = vec3(1.0, 0.0, -5.0);",
                             "after.staticFriction = 1e30; after.damping = -1e30;",
                             "after.force = vec3(1e37, 0.0, 0.0); after.stiffness = -4.0;"}) {
        TouchBench bench(planeOf(body));
        bench.step({-0.02, 0.0, 0.002});
        bench.moveTo({-0.02, 0.0, -kDepth}, 0.05);
        bench.moveTo({0.02, 0.0, -kDepth}, 0.1, [&](const HapticOutput& out) {
            ASSERT_TRUE(std::isfinite(glm::length(out.force))) << body;
            ASSERT_GE(out.force.z, -1e-9) << "it pulls: " << body;
            ASSERT_LE(glm::length(out.command.force()), bench.limits.maxForce + 1e-9) << body;
        });
    }
}

/// A loop of about half the budget: one contact has a result, the second of a corner has none left.
TEST(ProgramEffect, TheContactsOfACornerShareTheBudget) {
    const std::string body =
        "float sum = 0.0; for (int i = 0; i < 500; ++i) sum += sin(float(i)) * before.position.x;"
        "after.force *= 1.0 + 1e-6 * sum;";
    TouchBench plane(planeOf(body));
    forceAt(plane, 0.0, 0.0);
    EXPECT_FALSE(has(plane.output.flags, TickFlag::ProgramFailed));

    Scene corner = cornerScene(groove(1.5707963, 500.0f, 500.0f));
    for (Material& material : corner.materials)
        giveProgram(material, body);
    TouchBench bench(corner);
    bench.step({0.0, 0.02, 0.0});
    bench.moveTo({0.0, -0.001, 0.0}, 0.05);
    EXPECT_EQ(bench.output.planeCount, 2u);
    EXPECT_TRUE(has(bench.output.flags, TickFlag::ProgramFailed));
    EXPECT_NEAR(bench.output.force.y, 500.0 * 1e-3, 0.05) << "one wall by its program, one plain";
}

/// Two walls with a program push like one wall each; coplanar facets do not add up what it displaces.
TEST(ProgramEffect, SeveralContactsAddUpLikeTheirLoads) {
    const std::string body =
        "after.position += 2e-4 * before.normal; after.stiffness = 0.5 * before.stiffness;";
    Scene corner = cornerScene(groove(1.5707963, 500.0f, 800.0f));
    for (Material& material : corner.materials)
        giveProgram(material, body);
    TouchBench bench(corner);
    bench.step({0.0, 0.02, 0.0});
    bench.moveTo({0.0, -0.002, 0.0}, 0.05);
    for (int i = 0; i < 200; ++i)
        bench.step({0.0, -0.002, 0.0});
    ASSERT_EQ(bench.output.planeCount, 2u);
    // Each wall is pressed by d = 2 mm / sqrt 2, and 0.2 mm nearer: k' (d + h).
    const double d = 0.002 * std::sqrt(0.5), left = 0.5 * 500.0 * (d + 2e-4),
                 right = 0.5 * 800.0 * (d + 2e-4);
    EXPECT_NEAR(glm::length(bench.output.force), std::hypot(left, right), 3.0 * kGapForce);
}

TEST(ProgramEffect, ATickDoesNotAllocateWithPrograms) {
    TouchBench bench(planeOf("after.position.z += 1e-4 * noise(before.position * 400.0);"));
    bench.step({-0.02, 0.0, 0.002});
    bench.moveTo({-0.02, 0.0, -kDepth}, 0.05);
    const uint64_t before = allocationsOnThisThread();
    bench.moveTo({0.02, 0.01, -kDepth}, 0.1);
    EXPECT_EQ(allocationsOnThisThread(), before);
}

TEST(ProgramEffect, ThePlanNamesItAndTakesItOff) {
    const Scene source = planeOf("after.staticFriction = 0.6;");
    const auto scene = compileHapticScene(source, Similarity{});
    const auto planned = [](const HapticScene& of) {
        return *std::ranges::find(of.plan.effects, Effect::Program, &PlannedEffect::effect);
    };
    EXPECT_TRUE(planned(*scene).on);
    EXPECT_NE(planned(*scene).reason.find("test.glsl"), std::string::npos) << planned(*scene).reason;
    EXPECT_GT(planned(*scene).memoryBytes, 0u);
    EXPECT_FALSE(scene->plan.plainSample);
    const auto without = copyOf(*scene);
    removeEffect(*without, 0, Effect::Program);
    EXPECT_FALSE(without->plan.programs);
    EXPECT_TRUE(without->plan.plainSample);
}

TEST(ProgramEffect, AnEditOfAValueChangesTheSceneAndItsIdentity) {
    const std::string declared = "parameter float k = 0.5; // 0..2\n";
    const std::string body = "after.stiffness = k * before.stiffness;";
    const Scene source = planeOf(body, json::object(), declared);
    const auto scene = compileHapticScene(source, Similarity{});
    Scene changed = source;
    giveProgram(changed.materials[0], body, {{"k", 0.25}}, declared);
    EXPECT_EQ(changed.materials[0].haptic.program.compiled, source.materials[0].haptic.program.compiled);
    const auto edited = withMaterials(*scene, source, source.materials, changed.materials);
    EXPECT_NE(feltHash(*scene, source), feltHash(*edited, source));
    EXPECT_EQ(feltHash(*scene, source), feltHash(*compileHapticScene(source, Similarity{}), source));
    EXPECT_EQ(feltHash(*edited, source), feltHash(*compileHapticScene(changed, Similarity{}), changed));

    TouchBench bench(source);
    const double before = forceAt(bench, 0.0, 0.0).z;
    bench.scene = edited;
    bench.step({0.0, 0.0, -kDepth});
    EXPECT_NEAR(bench.output.force.z, 0.5 * before, 1e-6) << "felt in the next tick";
}

} // namespace
} // namespace touchstone::test::program_effect_test

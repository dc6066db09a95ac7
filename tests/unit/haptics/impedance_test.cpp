// Stiffness and damping by scalar, vertex and map in closed form [001 §4.2.2, §4.3], and steps in the maps
// and settings of impedance and friction under a hand.

#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>

namespace touchstone::test::impedance_test {
namespace {

constexpr std::array kModels{FrictionMode::Zilles, FrictionMode::Ho, FrictionMode::Elastoplastic};

HapticSettings plain() {
    HapticSettings s;
    s.forceShading = ShadingMode::Off;
    s.texture = TextureMode::Off;
    s.friction = FrictionMode::Off;
    return s;
}

/// A map of two texels side by side, dark at small u.
FactorMap twoTexels(Scene& scene, float min, float max) {
    Image image;
    image.decoded = true;
    image.pixels.width = 2;
    image.pixels.height = 1;
    image.pixels.channels = 1;
    image.pixels.type = ComponentType::F32;
    const std::array<float, 2> texels{0.0f, 1.0f};
    image.pixels.bytes.resize(sizeof texels);
    std::memcpy(image.pixels.bytes.data(), texels.data(), sizeof texels);
    FactorMap map;
    map.texture.image = static_cast<int>(scene.images.size());
    map.min = min;
    map.max = max;
    scene.images.push_back(image);
    return map;
}

/// Presses and strokes; every tick's normal force is k(x) d - b(x) v_n.
template <class StiffnessAt, class DampingAt>
void expectImpedance(const Scene& scene, const StiffnessAt& stiffness, const DampingAt& damping) {
    TouchBench bench(scene, plain());
    int judged = 0;
    const auto judge = [&](const HapticOutput& out) {
        if (out.contacts == 0)
            return;
        const double x = out.proxy.x, elastic = stiffness(x) * out.penetration;
        const double expected = std::max(0.0, elastic - damping(x) * out.hipVelocity.y);
        EXPECT_NEAR(out.force.y, expected, 1e-9 * std::max(1.0, expected)) << "x " << x;
        ++judged;
    };
    bench.step({-0.04, 0.005, 0.01});
    bench.moveTo({-0.04, -0.001, 0.01}, 0.05, judge);
    bench.moveTo({0.04, -0.002, -0.02}, 0.1, judge);
    bench.moveTo({0.04, 0.001, -0.02}, 0.05, judge);
    EXPECT_GT(judged, 500);
}

TEST(Impedance, ScalarVertexAndMapGiveTheClosedForm) {
    Scene scalar = sceneOf(assets::plane(0.2, 0.2, 2, 2));
    scalar.materials[0].haptic.stiffness = {700.0f, HapticSource::Touchstone};
    scalar.materials[0].haptic.damping = {2.0f, HapticSource::Touchstone};
    expectImpedance(
        scalar, [](double) { return 700.0; }, [](double) { return 2.0; });

    // Linear in x over the whole plane, so that every triangle interpolates the same line.
    Scene vertex = scalar;
    const double half = static_cast<double>(0.1f);
    for (const glm::vec3& p : vertex.meshes[0].positions) {
        vertex.meshes[0].stiffness.push_back(500.0f + 125.0f * (p.x / 0.1f));
        vertex.meshes[0].damping.push_back(1.0f + 0.5f * (p.x / 0.1f));
    }
    expectImpedance(
        vertex, [&](double x) { return 500.0 + 125.0 * x / half; },
        [&](double x) { return 1.0 + 0.5 * x / half; });

    // Two texels: constant up to the middle of the first, then straight to the middle of the second.
    Scene map = scalar;
    map.materials[0].haptic.stiffnessMap = {twoTexels(map, 0.5f, 1.0f), HapticSource::Touchstone};
    map.materials[0].haptic.dampingMap = {twoTexels(map, 0.0f, 2.0f), HapticSource::Touchstone};
    const auto white = [half](double x) { return 0.5 + x / half; }; // |x| < 0.05
    expectImpedance(
        map, [&](double x) { return 700.0 * (0.5 + 0.5 * white(x)); },
        [&](double x) { return 2.0 * 2.0 * white(x); });
}

TEST(Impedance, FrictionByMapAndVertexIsReadUnderTheHandAndTheViscousTermAloneUsesVelocity) {
    const double half = static_cast<double>(0.1f);
    Scene map = sceneOf(assets::plane(0.2, 0.2, 2, 2));
    map.materials[0].haptic.staticFriction = {0.5f, HapticSource::Touchstone};
    map.materials[0].haptic.dynamicFriction = {0.25f, HapticSource::Touchstone};
    Scene vertex = map;
    map.materials[0].haptic.friction = {twoTexels(map, 0.5f, 2.0f), HapticSource::Touchstone};
    for (const glm::vec3& p : vertex.meshes[0].positions)
        vertex.meshes[0].friction.push_back(0.5f + 0.25f * (p.x / 0.1f));
    HapticSettings s = plain();
    s.stiffness = 1000.0;
    for (const FrictionMode model : {FrictionMode::Ho, FrictionMode::Elastoplastic})
        for (const bool byMap : {true, false}) {
            s.friction = model;
            TouchBench bench(byMap ? map : vertex, s);
            bench.step({0.04, 0.001, 0.0});
            bench.moveTo({0.04, -0.001, 0.0}, 0.05);
            int sliding = 0;
            // Towards the smaller coefficient: whoever slides goes on sliding.
            bench.moveTo({-0.04, -0.001, 0.0}, 0.02, [&](const HapticOutput& out) {
                if (out.friction != FrictionState::Sliding)
                    return;
                ++sliding;
                const double x = out.hip.x / half;
                const double mu = byMap ? 0.25 * (0.5 + 1.5 * (0.5 + x)) : 0.5 * (0.5 + 0.25 * x);
                EXPECT_NEAR(out.force.x, mu * out.force.y, 1e-9) << "x " << out.hip.x;
            });
            EXPECT_GT(sliding, 3000);
        }

    Scene viscous = sceneOf(assets::plane(0.2, 0.2, 2, 2));
    viscous.materials[0].haptic.viscousFriction = {4.0f, HapticSource::Touchstone};
    s.friction = FrictionMode::Zilles;
    TouchBench bench(viscous, s);
    bench.step({0.04, 0.001, 0.0});
    bench.moveTo({0.04, -0.001, 0.0}, 0.05);
    bench.moveTo({0.0, -0.001, 0.01}, 0.1, [&](const HapticOutput& out) {
        EXPECT_NEAR(out.force.x, -4.0 * out.hipVelocity.x, 1e-9);
        EXPECT_NEAR(out.force.z, -4.0 * out.hipVelocity.z, 1e-9);
    });
    EXPECT_GT(bench.output.force.x, 0.3);
}

/// A plane with a cliff of `width` m at x = 0, by vertices: stiffness, damping and friction step up there.
Scene cliff(double width) {
    assets::Shape shape;
    const auto w = static_cast<float>(0.5 * width);
    for (const float x : {-0.1f, -w, w, 0.1f})
        for (const float z : {-0.1f, 0.1f})
            shape.positions.emplace_back(x, 0.0f, z);
    for (uint32_t i = 0; i < 6; i += 2)
        for (const uint32_t k : {0u, 1u, 2u, 2u, 1u, 3u})
            shape.indices.push_back(i + k);
    Scene scene = sceneOf(shape);
    for (const glm::vec3& p : scene.meshes[0].positions) {
        const bool right = p.x > 0.0f;
        scene.meshes[0].stiffness.push_back(right ? 1200.0f : 300.0f);
        scene.meshes[0].damping.push_back(right ? 3.0f : 0.0f);
        scene.meshes[0].friction.push_back(right ? 0.9f : 0.1f);
    }
    scene.materials[0].haptic.staticFriction = {0.5f, HapticSource::Touchstone};
    scene.materials[0].haptic.dynamicFriction = {0.4f, HapticSource::Touchstone};
    return scene;
}

TEST(Impedance, StepsUnderAHandAreBoundedByTheLawAndDoNotBuzzWhileHeld) {
    for (const FrictionMode model : kModels)
        for (const double width : {1e-3, 2e-5}) { // the second is two ticks wide
            HapticSettings s = plain();
            s.friction = model;
            TouchBench bench(cliff(width), s);
            SCOPED_TRACE(settingValue(s, "friction") + " " + std::to_string(width));
            bench.step({-0.004, 0.001, 0.0});
            bench.moveTo({-0.004, -0.001, 0.0}, 0.02);
            HapticOutput last = bench.output;
            const double step = 1e-5, k = 1200.0, depth = 1.001e-3;
            // In a tick k changes by at most its slope times the step, and with it the whole force; the
            // spring by k times the step; and of the stretch, which may reach back to where the coefficient
            // was larger, all may go.
            const double share = std::min(1.0, step / width);
            const double force = k * depth;
            const double most = k * step + share * 900.0 * depth * (1.0 + 0.9) + 0.9 * force;
            for (const double to : {0.004, -0.004})
                bench.moveTo({to, -0.001, 0.0}, 0.01, [&](const HapticOutput& out) {
                    ASSERT_TRUE(std::isfinite(glm::length(out.force)));
                    EXPECT_LE(glm::distance(out.force, last.force), most);
                    EXPECT_LE(std::hypot(out.force.x, out.force.z), 0.9 * force * (1.0 + 1e-9));
                    last = out;
                });
            for (const double at : {-1e-5, 0.0, 0.3e-5, 1e-5, 4e-4}) {
                bench.moveTo({at, -0.001, 0.0}, 0.01);
                for (int i = 0; i < 100; ++i) // the velocity's filter comes to rest
                    bench.step({at, -0.001, 0.0});
                const glm::dvec3 settled = bench.output.force;
                for (int i = 0; i < 200; ++i)
                    ASSERT_LT(glm::distance(bench.step({at, -0.001, 0.0}).force, settled), 1e-9);
            }
        }
}

TEST(Impedance, FrictionToggledAndItsLawChangedInContactStayInTheCone) {
    HapticSettings s = plain();
    s.stiffness = 1000.0;
    s.staticFriction = 0.6;
    s.dynamicFriction = 0.4;
    TouchBench bench(sceneOf(assets::plane(0.2, 0.2, 2, 2)), s);
    bench.step({-0.05, 0.001, 0.0});
    bench.moveTo({-0.05, -0.001, 0.0}, 0.05);
    const double normal = bench.output.force.y;
    glm::dvec3 last = bench.output.force;
    for (int i = 0; i < 4000; ++i) {
        if (i % 37 == 0)
            bench.settings.friction = static_cast<FrictionMode>((i / 37 * 7 / 3) % 4);
        bench.step(bench.output.hip + (i % 500 < 300 ? glm::dvec3(2e-5, 0, 1e-5) : glm::dvec3(0.0)));
        const glm::dvec3 f = bench.output.force;
        EXPECT_NEAR(f.y, normal, 1e-9);
        EXPECT_LE(std::hypot(f.x, f.z), 0.6 * normal * (1.0 + 1e-9));
        EXPECT_LE(glm::distance(f, last), 0.6 * normal + 1000.0 * 3e-5);
        if (bench.settings.friction == FrictionMode::Off) {
            EXPECT_EQ(std::hypot(f.x, f.z), 0.0);
        }
        last = f;
    }
}

} // namespace
} // namespace touchstone::test::impedance_test

// Effects that are switched on and off under a hand.

#include "tests/stability/surface/touched_plane.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace touchstone::test::toggles_test {
namespace {

TEST(TextureStability, RungsChangedInContactChangeTheForceAndNothingElse) {
    const double scale = 0.02;
    TouchBench bench(reliefPlane(slopeImage(256), scale), felt(TextureMode::Off));
    bench.step({0.01, 0.003, 0.001});
    for (int i = 0; i <= 100; ++i)
        bench.step({0.01, 0.003, 0.001 - 2e-5 * i});
    for (int i = 0; i < 200; ++i)
        bench.step(bench.output.hip);
    const HapticOutput flat = bench.output;
    glm::dvec3 first[4];
    for (int i = 0; i < 400; ++i) {
        const auto mode = static_cast<TextureMode>(i % 4);
        bench.settings.texture = mode;
        const HapticOutput& out = bench.step(flat.hip);
        EXPECT_EQ(out.proxy, flat.proxy);
        EXPECT_EQ(out.penetration, flat.penetration);
        if (i < 4)
            first[i] = out.force;
        EXPECT_EQ(out.force, first[i % 4]) << "no memory of the last rung";
        const double d = flat.penetration;
        EXPECT_LE(glm::length(out.force - flat.force), kStiffness * d * scale / kSide * (1.0 + 1e-6));
    }
    EXPECT_NE(first[0], first[1]);
    EXPECT_NE(first[2], first[3]);
}

/// A torus whose material asks for every effect.
Scene everything() {
    Scene scene;
    scene.materials.emplace_back();
    Material& material = scene.materials[0];
    scene.images.push_back(image("waves", 128, 128, 1, [](double u, double v) {
        return glm::vec4(
            static_cast<float>(0.5 + 0.25 * std::sin(32.0 * kPi * u) + 0.25 * std::cos(16.0 * kPi * v)));
    }));
    scene.images.push_back(image("lean", 128, 128, 3, [](double u, double) {
        return glm::vec4(0.5 + 0.5 * glm::normalize(glm::dvec3(0.2 * std::cos(32.0 * kPi * u), 0.1, 1.0)),
                         1.0);
    }));
    const auto stated = [](double value) -> HapticMaterial::Field<float> {
        return {static_cast<float>(value), HapticSource::Touchstone};
    };
    HeightMap heights;
    heights.texture = texture(0);
    heights.scale = 4e-4f;
    FactorMap factor;
    factor.texture = texture(0);
    factor.min = 0.4f;
    material.normalTexture = texture(1);
    HapticMaterial& haptic = material.haptic;
    haptic.height = {heights, HapticSource::Touchstone};
    haptic.stiffnessMap = haptic.dampingMap = haptic.friction = {factor, HapticSource::Touchstone};
    haptic.staticFriction = stated(0.6);
    haptic.dynamicFriction = stated(0.4);
    haptic.viscousFriction = stated(1.0);
    haptic.damping = stated(2.0);
    haptic.stiffness = stated(800.0);
    place(scene, torusMesh(0.06, 0.025, 90, 45, {4.0f, 2.0f}), 0);
    return scene;
}

/// Another choice of one effect.
void toggle(HapticSettings& s, uint_fast32_t dice) {
    switch (dice % 8) {
    case 0:
        s.texture = static_cast<TextureMode>(dice / 8 % 4);
        break;
    case 1:
        s.friction = static_cast<FrictionMode>(dice / 8 % 4);
        break;
    case 2:
        s.forceShading = static_cast<ShadingMode>(dice / 8 % 5);
        break;
    case 3:
        s.stiffness = dice / 8 % 2 == 0 ? 0.0 : 500.0;
        break;
    case 4:
        s.damping = dice / 8 % 2 == 0 ? -1.0 : 0.0;
        break;
    case 5:
        s.staticFriction = s.dynamicFriction = dice / 8 % 3 == 0 ? -1.0 : dice / 8 % 3 == 1 ? 0.0 : 10.0;
        break;
    case 6:
        s.textureStrength = dice / 8 % 2 == 0 ? 1.0 : 0.3;
        break;
    default:
        s.proxyRadius = dice / 8 % 2 == 0 ? 0.0 : 0.5e-3;
        break;
    }
}

TEST(Toggles, EveryEffectInEveryTickUnderAHandStaysFiniteAndWithinTheLaw) {
    constexpr double kMaxStiffness = 800.0, kMaxDamping = 2.0, kMaxViscous = 1.0;
    for (const unsigned seed : {1u, 2u, 3u, 4u}) {
        std::mt19937 random(seed);
        HapticSettings s;
        TouchBench bench(everything(), s);
        double most = 0.0, step = 0.0;
        glm::dvec3 command(0.0);
        const DeviceLimits& limits = bench.limits;
        for (int i = 0; i < 6000; ++i) {
            toggle(bench.settings, random());
            const double a = 4e-4 * i, t = 1.3 * a, tube = 0.025 - (i < 100 ? 1.3e-5 * i - 3e-4 : 1e-3);
            const double reach = 0.06 + tube * std::cos(t);
            const HapticOutput& out =
                bench.step({reach * std::sin(a), tube * std::sin(t), reach * std::cos(a)});
            ASSERT_TRUE(std::isfinite(out.force.x + out.force.y + out.force.z)) << i;
            // The spring, at most Minsky's under the cap or Ho's under his; the cone; the dampers.
            const double d = out.penetration, v = glm::length(out.hipVelocity);
            const double longest = 1.0 / std::cos(0.5236) * (1.0 + 10.0);
            EXPECT_LE(glm::length(out.force),
                      kMaxStiffness * d * longest + (kMaxDamping + kMaxViscous) * v + 1e-9)
                << i;
            most = std::max(most, glm::length(out.force));
            step = std::max(step, glm::distance(out.commandInWorkspace, command));
            command = out.commandInWorkspace;
        }
        EXPECT_GT(most, 0.5);
        EXPECT_LE(step, limits.maxForceRate * bench.dt * (1.0 + 1e-9)) << "what reaches the device";
        // Left alone, it stands still whatever was last chosen.
        for (int i = 0; i < 40; ++i) {
            toggle(bench.settings, random());
            EXPECT_EQ(held(bench), 0.0) << i;
        }
    }
}

TEST(Toggles, AllOffIsTheBareTickAndOnAgainIsAsIfNeverOff) {
    // What has no memory comes back to the last bit; friction begins anew where it was switched on.
    HapticSettings on, off;
    on.friction = off.friction = FrictionMode::Off;
    off.texture = TextureMode::Off;
    off.forceShading = ShadingMode::Off;
    TouchBench bench(everything(), on), bare(everything(), off), steady(everything(), on);
    const auto hip = [](int i) {
        const double tube = 0.025 - (i < 200 ? 1e-5 * i - 1e-3 : 1e-3), a = 1e-3 * i;
        return glm::dvec3(0.06 * std::sin(0.3) + tube * std::cos(a) * std::sin(0.3), tube * std::sin(a),
                          (0.06 + tube * std::cos(a)) * std::cos(0.3));
    };
    double apartOff = 0.0, apartOn = 0.0, differs = 0.0;
    for (int i = 0; i < 3000; ++i) {
        const bool isOff = i / 100 % 2 == 1;
        bench.settings = isOff ? off : on;
        bench.step(hip(i));
        bare.step(hip(i));
        steady.step(hip(i));
        if (i < 300 || i % 100 < 3)
            continue;
        const glm::dvec3 force = bench.output.force;
        (isOff ? apartOff : apartOn) =
            std::max(isOff ? apartOff : apartOn,
                     glm::distance(force, isOff ? bare.output.force : steady.output.force));
        differs = std::max(differs, glm::distance(bare.output.force, steady.output.force));
    }
    EXPECT_LT(apartOff, 1e-9);
    EXPECT_LT(apartOn, 1e-3) << "shading converges to where it would have been";
    EXPECT_GT(differs, 0.05);
}

} // namespace
} // namespace touchstone::test::toggles_test

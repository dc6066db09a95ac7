// Heights and normals at their worst: cliffs of one texel, heights that are crossed, numbers of any size. The
// force is finite, never longer or more tilted than the law lets it be, changes in a tick by no more than the
// law does for the step of the hand, and stands still with the hand.

#include "tests/stability/surface/touched_plane.h"

#include <algorithm>
#include <cmath>

namespace touchstone::test::relief_test {
namespace {

TEST(TextureStability, CliffsOfOneTexel) {
    constexpr int kTexels = 128;
    const double scale = 5e-4, texel = kSide / kTexels;
    const Image cliffs = cliffImage(kTexels);
    for (const TextureMode mode : kConfigurations)
        for (const double radius : {0.0, 0.5e-3})
            for (const double speed : {0.005, 0.02, 0.1, 0.38, 1.0})
                for (const double depth : {2e-4, 1e-3}) {
                    SCOPED_TRACE(std::to_string(static_cast<int>(mode)) + " r " + std::to_string(radius) +
                                 " at " + std::to_string(speed) + " m/s, depth " + std::to_string(depth));
                    TouchBench bench(reliefPlane(cliffs, scale), felt(mode, radius));
                    const double s = speed * bench.dt, cap = bench.settings.textureTiltLimit;
                    // Second and first differences of the map: 2 and 1 per texel, in two directions. What m
                    // can turn by at all is twice the cap. Minsky's length grows by 1 / cos^2 of it.
                    const double turn =
                        std::min(2.0 * std::sqrt(2.0) * 2.0 * scale / texel / texel * s, 2.0 * cap);
                    const double rise = std::min(2.0 * scale / texel * s, scale);
                    const double longer =
                        mode == TextureMode::Minsky ? 1.0 / std::pow(std::cos(cap), 2) : 1.0;
                    bench.step({-0.045, 0.003, 0.01});
                    bench.moveTo({-0.045, 0.003, -depth}, 0.05);
                    bench.moveTo({-0.025, 0.003 + 0.2 * 0.02, -depth}, speed); // the filter settles
                    const double deepest = depth + radius + 1e-6;
                    const double allowed =
                        kStiffness * longer * (s + deepest * turn + rise * 2.0 * std::sin(0.5 * cap));
                    Watch watch(bench);
                    watch.take(bench.output, allowed);
                    bench.moveTo({0.04, 0.02, -depth}, speed,
                                 [&](const HapticOutput& out) { watch.take(out, allowed); });
                    EXPECT_EQ(held(bench), 0.0);
                    if (speed < 0.01) {
                        EXPECT_GT(watch.compressed, watch.ticks / 20)
                            << "some cliffs are steeper than the cap";
                        EXPECT_GT(watch.worst, 0.02) << "the bound says nothing";
                    }
                    if (speed > 0.39) {
                        EXPECT_LT(watch.largest, 0.1 * kStiffness * deepest)
                            << "what would alias is left out";
                    }
                }
}

/// Texels that lean to either side in turn.
Image leaningCliffs(int texels, double lean) {
    return image("lean", texels, texels, 3, [=](double u, double v) {
        const int x = static_cast<int>(u * texels), y = static_cast<int>(v * texels);
        const double side = (x + y) % 2 == 0 ? 1.0 : -1.0;
        return glm::vec4(0.5 + 0.5 * glm::dvec3(side * std::sin(lean), 0.0, std::cos(lean)), 1.0);
    });
}

TEST(TextureStability, CliffsOfOneTexelInANormalMap) {
    constexpr int kTexels = 128;
    const double texel = kSide / kTexels;
    for (const double lean : {0.2, 1.2}) // rad; the second is compressed
        for (const double radius : {0.0, 0.5e-3})
            for (const double speed : {0.005, 0.02, 0.1, 0.38, 1.0})
                for (const double depth : {2e-4, 1e-3}) {
                    SCOPED_TRACE("lean " + std::to_string(lean) + " r " + std::to_string(radius) + " at " +
                                 std::to_string(speed) + " m/s, depth " + std::to_string(depth));
                    Scene scene;
                    scene.materials.emplace_back();
                    scene.images.push_back(leaningCliffs(kTexels, lean));
                    scene.materials[0].normalTexture = texture(0);
                    place(scene, quadMesh(0.5 * kSide, 4), 0);
                    TouchBench bench(scene, felt(TextureMode::Law, radius));
                    const double s = speed * bench.dt, cap = bench.settings.textureTiltLimit;
                    // From texel to texel what is read changes by 2 sin(lean), in both directions, and is
                    // nowhere shorter than cos(lean).
                    const double turn =
                        std::min(std::sqrt(2.0) * 2.0 * std::tan(lean) * s / texel, 2.0 * cap);
                    const double deepest = depth + radius + 1e-6;
                    const double allowed = kStiffness * (s + deepest * turn);
                    bench.step({-0.045, 0.003, 0.01});
                    bench.moveTo({-0.045, 0.003, -depth}, 0.05);
                    bench.moveTo({-0.025, 0.003 + 0.2 * 0.02, -depth}, speed); // the filter settles
                    Watch watch(bench);
                    watch.take(bench.output, allowed);
                    double most = 0.0;
                    bench.moveTo({0.04, 0.02, -depth}, speed, [&](const HapticOutput& out) {
                        watch.take(out, allowed);
                        most = std::max(most, std::abs(out.force.x) / out.force.z);
                    });
                    EXPECT_EQ(held(bench), 0.0);
                    EXPECT_LE(most, std::tan(cap) * (1.0 + 1e-9));
                    if (speed < 0.39) {
                        EXPECT_GT(most, 0.8 * std::min(std::tan(lean), 0.9 * std::tan(cap)));
                        EXPECT_GT(watch.worst, 0.02) << "the bound says nothing";
                    } else {
                        EXPECT_LT(most, 1e-2) << "what would alias is left out";
                    }
                }
}

TEST(TextureStability, DepthThroughTheHeightIsContinuous) {
    const double scale = 0.004;
    for (const double limit : {0.5 * kPi, 0.4363323129985824}) {
        HapticSettings s = felt(TextureMode::Law);
        s.textureTiltLimit = limit;
        TouchBench bench(reliefPlane(slopeImage(256), scale), s);
        const double step = 1e-6;
        bench.step({0.01, 0.003, 0.001});
        for (int i = 0; i <= 200; ++i)
            bench.step({0.01, 0.003, 0.001 - 1.2e-5 * i});
        Watch watch(bench);
        int crossed = 0;
        bool above = bench.output.penetration >= bench.output.height;
        watch.take(bench.output, 1.0);
        EXPECT_FALSE(above);
        for (int i = 0; i <= 2500; ++i) {
            const HapticOutput& out = bench.step({0.01, 0.003, -0.0014 - step * i});
            watch.take(out, kStiffness * step * (1.0 + 1e-6)); // dF/dd is k n or k m
            const bool now = out.penetration >= out.height;
            crossed += now != above ? 1 : 0;
            above = now;
        }
        EXPECT_EQ(crossed, 1);
        EXPECT_TRUE(above);
        EXPECT_EQ(held(bench), 0.0);
    }
}

TEST(TextureStability, MapsOfAnyNumbersStayHarmless) {
    // Floats of any size, among them none: everything is finite and no steeper than the cap.
    for (const float wild : {INFINITY, -INFINITY, NAN, 3e38f, -3e38f})
        for (const bool normalMap : {false, true}) {
            Image broken;
            broken.decoded = true;
            broken.pixels = {4, 4, 3, ComponentType::F32, {}};
            for (int i = 0; i < 48; ++i) {
                const float value = i % 5 == 0 ? wild : 0.1f * static_cast<float>(i % 7);
                const auto* bytes = reinterpret_cast<const std::byte*>(&value);
                broken.pixels.bytes.insert(broken.pixels.bytes.end(), bytes, bytes + sizeof value);
            }
            for (const TextureMode mode : kConfigurations) {
                Scene scene = reliefPlane(broken, 0.01);
                if (normalMap)
                    scene.materials[0].normalTexture = texture(0);
                TouchBench bench(scene, felt(mode));
                Watch watch(bench);
                bench.step({-0.04, 0.003, 0.01});
                bench.moveTo({0.04, 0.023, -1e-3}, 0.1,
                             [&](const HapticOutput& out) { watch.take(out, 10.0); });
                EXPECT_GT(watch.ticks, 100);
            }
        }
}

} // namespace
} // namespace touchstone::test::relief_test

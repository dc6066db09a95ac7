// Shading and texture against their formulas: the prism of [000 Fig. 6], and the displacement force law on a
// sine.

#include "tests/support/test_shapes.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <vector>

namespace touchstone::test::surface_effects_test {
namespace {

constexpr double kPi = 3.141592653589793;

HapticSettings bare() {
    HapticSettings s;
    s.forceShading = ShadingMode::Off;
    s.texture = TextureMode::Off;
    s.friction = FrictionMode::Off;
    s.stiffness = 1000.0;
    return s;
}

/// Angle in degrees between the force and the radius of the circle, over one turn at 0.85 of the
/// circumradius.
struct PrismTurn {
    double worstAngle = 0.0, worstJump = 0.0;
};
PrismTurn turnAroundPrism(bool smooth, ShadingMode mode) {
    HapticSettings s = bare();
    s.forceShading = mode;
    TouchBench bench(sceneOf(assets::prism(10, 0.05, 0.2, smooth)), s);
    const double path = 0.85 * 0.05;
    bench.step({0.08, 0.0, 0.0});
    bench.moveTo({path, 0.0, 0.0}, 0.1);
    PrismTurn turn;
    glm::dvec3 last = bench.output.force;
    const int ticks = static_cast<int>(2.0 * kPi * path / 1e-4);
    for (int i = 0; i <= ticks; ++i) {
        const double a = 2.0 * kPi * i / ticks;
        bench.step({path * std::cos(a), 0.0, path * std::sin(a)});
        EXPECT_GT(bench.output.contacts, 0u);
        const glm::dvec3 f = bench.output.force;
        const double outward = glm::dot(glm::normalize(f), glm::dvec3(std::cos(a), 0.0, std::sin(a)));
        if (i > 20) {
            turn.worstAngle = std::max(turn.worstAngle, std::acos(std::min(1.0, outward)) * 180.0 / kPi);
            turn.worstJump = std::max(turn.worstJump, glm::length(f - last));
        }
        last = f;
    }
    return turn;
}

TEST(ForceShading, OnTheTenSidedPrismTheForceIsPerpendicularToTheCircle) {
    const PrismTurn flat = turnAroundPrism(true, ShadingMode::Off);
    const PrismTurn shaded = turnAroundPrism(true, ShadingMode::TwoPass);
    EXPECT_GT(flat.worstAngle, 10.0);
    EXPECT_GT(flat.worstJump, 0.5) << "the proxy jumps over the edge";
    EXPECT_LT(shaded.worstAngle, 0.5);
    EXPECT_LT(shaded.worstJump, 0.05);
}

TEST(ForceShading, FlatNormalsLeaveTheFacetsAlone) {
    const PrismTurn flat = turnAroundPrism(false, ShadingMode::Off);
    const PrismTurn shaded = turnAroundPrism(false, ShadingMode::TwoPass);
    EXPECT_EQ(flat.worstAngle, shaded.worstAngle);
    EXPECT_EQ(flat.worstJump, shaded.worstJump);
}

TEST(ForceShading, DirectionAndProjectionTurnTheForceToTheInterpolatedNormal) {
    for (const ShadingMode mode : {ShadingMode::Direction, ShadingMode::Projected}) {
        HapticSettings s = bare();
        s.forceShading = mode;
        TouchBench bench(sceneOf(assets::prism(10, 0.05, 0.2, true)), s);
        bench.step({0.08, 0.0, 0.003});
        bench.moveTo({0.046, 0.0, 0.003}, 0.05);
        ASSERT_GT(bench.output.contacts, 0u);
        // Smooth normals of the prism are radial: between two corners the interpolated one is nearly so.
        const glm::dvec3 radial = glm::normalize(glm::dvec3(bench.output.proxy.x, 0.0, bench.output.proxy.z));
        const double angle = std::acos(std::min(1.0, glm::dot(glm::normalize(bench.output.force), radial)));
        EXPECT_LT(angle * 180.0 / kPi, 0.5);
    }
}

/// A plane of 0.2 m with a sine in u as height map (F32), `scale` m high, `waves` over the plane.
Scene sinePlane(double scale, int waves, int texels) {
    Scene scene = sceneOf(assets::plane(0.2, 0.2, 2, 2));
    Image image;
    image.name = "sine";
    image.decoded = true;
    image.pixels.width = texels;
    image.pixels.height = 1;
    image.pixels.channels = 1;
    image.pixels.type = ComponentType::F32;
    image.pixels.bytes.resize(sizeof(float) * static_cast<size_t>(texels));
    for (int x = 0; x < texels; ++x) {
        const float h = static_cast<float>(0.5 + 0.5 * std::sin(2.0 * kPi * waves * (x + 0.5) / texels));
        std::memcpy(&image.pixels.bytes[sizeof(float) * static_cast<size_t>(x)], &h, sizeof h);
    }
    scene.images.push_back(image);
    HeightMap map;
    map.texture.image = 0;
    map.scale = static_cast<float>(scale);
    scene.materials[0].haptic.height = {map, HapticSource::Touchstone};
    return scene;
}

TEST(Texture, TheForceOnASineFollowsTheDisplacementLaw) {
    const double scale = 4e-4;
    const int waves = 10;
    HapticSettings s = bare();
    s.texture = TextureMode::Law;
    s.textureTiltLimit = kPi / 2.0;
    TouchBench bench(sceneOf(assets::plane(0.2, 0.2, 2, 2)), s);
    bench.scene = compileHapticScene(sinePlane(scale, waves, 2048), Similarity{});
    for (const double depth : {1e-3, 3e-4, 1e-4}) {
        bench.state[0].forgetTouch();
        bench.step({-0.05, 0.01, 0.0});
        bench.moveTo({-0.05, -depth, 0.0}, 0.05);
        int below = 0, above = 0;
        bench.moveTo({0.05, -depth, 0.0}, 0.02, [&](const HapticOutput& out) {
            const double x = out.hip.x, phase = 2.0 * kPi * waves * (x / 0.2 + 0.5);
            const double height = scale * (0.5 + 0.5 * std::sin(phase));
            const double slope = scale * 0.5 * std::cos(phase) * 2.0 * kPi * waves / 0.2;
            const glm::dvec3 n(0, 1, 0), m = glm::normalize(glm::dvec3(-slope, 1.0, 0.0));
            const double d = depth + 0.5 * kWeldTolerance * std::sqrt(0.08);
            const glm::dvec3 expected = 1000.0 * (d >= height ? (d - height) * n + height * m : d * m);
            (d >= height ? above : below) += 1;
            EXPECT_NEAR(out.height, height, 0.002 * scale);
            EXPECT_LT(glm::length(out.force - expected), 0.01 * glm::length(expected))
                << "x " << x << " depth " << depth;
        });
        EXPECT_GT(above, 100);
        if (depth < scale) {
            EXPECT_GT(below, 100);
        }
    }
}

/// A map is as high as its scale times its texels, whatever the scale, one metre too: half a millimetre above
/// the middle adds as much to the depth.
TEST(Texture, AnEvenHeightAddsToTheDepthAtEveryScale) {
    constexpr double kHigh = 5e-4, kDepth = 2e-3;
    for (const double scale : {1e-3, 0.1, 1.0, 2.0}) {
        Scene scene = sinePlane(scale, 1, 8);
        const auto texel = static_cast<float>(0.5 + kHigh / scale);
        std::vector<std::byte>& bytes = scene.images[0].pixels.bytes;
        for (size_t at = 0; at < bytes.size(); at += sizeof texel)
            std::memcpy(&bytes[at], &texel, sizeof texel);
        HapticSettings s = bare();
        s.texture = TextureMode::BlinnMagnitude;
        TouchBench bench(scene, s);
        bench.step({0.01, 0.01, 0.003});
        bench.moveTo({0.01, -kDepth, 0.003}, 0.1);
        const double skin = 0.5 * kWeldTolerance * std::sqrt(0.08);
        EXPECT_NEAR(bench.output.force.y, 1000.0 * (kDepth + skin + kHigh), 1e-3) << scale;
    }
}

TEST(Texture, FastStrokesDoNotBuzzWithWhatTheServoCannotSample) {
    // 200 waves on 0.2 m: at 1 m/s and 1 kHz each tick strokes one whole wave. Unfiltered it would alias to
    // noise.
    HapticSettings s = bare();
    s.texture = TextureMode::Law;
    TouchBench bench(sceneOf(assets::plane(0.2, 0.2, 2, 2)), s);
    bench.scene = compileHapticScene(sinePlane(1e-4, 200, 4096), Similarity{});
    bench.step({-0.05, 0.01, 0.0});
    bench.moveTo({-0.05, -1e-3, 0.0}, 0.05);
    double slow = 0.0, fast = 0.0;
    bench.moveTo({-0.04, -1e-3, 0.0}, 0.01,
                 [&](const HapticOutput& out) { slow = std::max(slow, std::abs(out.force.x)); });
    bench.moveTo({0.0, -1e-3, 0.0}, 1.03); // reach the speed
    bench.moveTo({0.08, -1e-3, 0.0}, 1.03,
                 [&](const HapticOutput& out) { fast = std::max(fast, std::abs(out.force.x)); });
    EXPECT_GT(slow, 0.01);
    EXPECT_LT(fast, 0.05 * slow);
}

TEST(Texture, ANormalMapTurnsTheForceAndTheSeamOfItsFrameIsRespected) {
    // A constant map leaning by atan(0.5) towards +u on a sphere-free plane: m = normalize(t/2 + n).
    Scene scene = sceneOf(assets::plane(0.2, 0.2, 2, 2));
    Image image;
    image.decoded = true;
    image.pixels.width = image.pixels.height = 1;
    image.pixels.channels = 3;
    image.pixels.type = ComponentType::F32;
    const glm::dvec3 lean = glm::normalize(glm::dvec3(0.5, 0.25, 1.0));
    const glm::vec3 stored(0.5 * lean + 0.5);
    image.pixels.bytes.resize(sizeof stored);
    std::memcpy(image.pixels.bytes.data(), &stored, sizeof stored);
    scene.images.push_back(image);
    scene.materials[0].normalTexture.image = 0;
    HapticSettings s = bare();
    s.texture = TextureMode::Law;
    s.textureTiltLimit = kPi / 2.0;
    TouchBench bench(scene, s);
    bench.step({0.01, 0.01, 0.0});
    bench.moveTo({0.01, -1e-3, 0.0}, 0.05);
    // u runs along +x; the bitangent points to the image's top, which is -v and so -z.
    const glm::dvec3 expected = glm::normalize(glm::dvec3(0.5, 1.0, -0.25));
    EXPECT_LT(glm::length(glm::normalize(bench.output.force) - expected), 1e-4);

    bench.settings.textureTiltLimit = 5.0 * kPi / 180.0;
    bench.step(bench.output.hip);
    const double tilt = std::acos(glm::normalize(bench.output.force).y) * 180.0 / kPi;
    EXPECT_LT(tilt, 5.0);
    EXPECT_GT(tilt, 4.5);
    EXPECT_TRUE(has(bench.output.flags, TickFlag::TiltCompressed));
}

TEST(Texture, TheTangentsOfTheFileSayWhichWayANormalMapLeans) {
    const double lean = 0.2, up = 2.0 * 252.0 / 255.0 - 1.0; // of the map's texels
    for (const bool alongU : {true, false})
        for (const float handed : {1.0f, -1.0f}) {
            Scene scene;
            scene.materials.emplace_back().normalTexture = texture(0);
            scene.images.push_back(image("lean", 4, 4, 3, [&](double, double) {
                return glm::vec4(alongU ? 0.6f : 0.5f, alongU ? 0.5f : 0.6f, 0.988f, 1.0f);
            }));
            Mesh mesh = quadMesh(0.05, 2);
            mesh.tangents.assign(mesh.positions.size(),
                                 glm::vec4(0.0f, 1.0f, 0.0f, handed)); // u runs along x
            place(scene, std::move(mesh), 0);
            TouchBench bench(scene);
            bench.settings.textureTiltLimit = glm::half_pi<double>();
            bench.settings.textureFilter = TextureFilter::Bilinear;
            bench.step({0.003, 0.004, 0.001});
            const glm::dvec3 normal = bench.step({0.003, 0.004, -0.001}).normal;
            EXPECT_NEAR(normal.y / normal.z, alongU ? lean / up : 0.0, 0.01);
            EXPECT_NEAR(normal.x / normal.z, alongU ? 0.0 : -static_cast<double>(handed) * lean / up, 0.01);
        }
}

/// A texel whose normal lies in the surface, or points into it, tilts as far as the steepest slope, 1 / 0.05,
/// and never turns the force around.
TEST(Texture, ANormalMapThatPointsIntoTheSurfaceTiltsByTheSteepestSlope) {
    for (const float blue : {127.0f / 255.0f, 0.25f, 0.0f}) { // z = -0.004, -0.5, -1
        Scene scene;
        scene.materials.emplace_back().normalTexture = texture(0);
        scene.images.push_back(
            image("steep", 4, 4, 3, [&](double, double) { return glm::vec4(1.0f, 0.5f, blue, 1.0f); }));
        Mesh mesh = quadMesh(0.05, 2);
        mesh.tangents.assign(mesh.positions.size(), glm::vec4(1.0f, 0.0f, 0.0f, 1.0f));
        place(scene, std::move(mesh), 0);
        TouchBench bench(scene);
        bench.settings.textureTiltLimit = glm::half_pi<double>();
        bench.settings.textureFilter = TextureFilter::Bilinear;
        bench.settings.textureStrength = 0.5;
        bench.step({0.003, 0.004, 0.001});
        const glm::dvec3 normal = bench.step({0.003, 0.004, -0.001}).normal;
        EXPECT_NEAR(normal.x / normal.z, 1.0 / 0.05, 1e-2) << blue;
        EXPECT_GT(normal.z, 0.0) << blue;
    }
}

/// (0.5, 0.5, 0) is the direction (0, 0, -1), of which nothing is left above the surface.
TEST(Texture, ATexelStraightIntoTheSurfaceLeavesThePlainForce) {
    Scene scene = sceneOf(assets::plane(0.2, 0.2, 2, 2));
    Image image;
    image.decoded = true;
    image.pixels.width = image.pixels.height = 1;
    image.pixels.channels = 3;
    image.pixels.type = ComponentType::F32;
    const glm::vec3 stored(0.5f, 0.5f, 0.0f);
    image.pixels.bytes.resize(sizeof stored);
    std::memcpy(image.pixels.bytes.data(), &stored, sizeof stored);
    scene.images.push_back(image);
    scene.materials[0].normalTexture.image = 0;
    for (const double limit : {0.25 * kPi, 0.5 * kPi}) {
        HapticSettings s = bare();
        s.texture = TextureMode::Law;
        s.textureTiltLimit = limit;
        TouchBench bench(scene, s);
        bench.step({0.01, 0.01, 0.0});
        bench.moveTo({0.01, -1e-3, 0.0}, 0.05);
        const glm::dvec3& f = bench.output.force;
        EXPECT_NEAR(f.y, -1000.0 * bench.output.hip.y, 2e-4) << "up to the proxy's gap";
        EXPECT_LT(std::hypot(f.x, f.z), 1e-9) << limit;
    }
}

} // namespace
} // namespace touchstone::test::surface_effects_test

// Maps at their worst: cliffs of one texel, seams, mirrored and collapsed coordinates, broken tangents, node
// scales, heights that are crossed, borders of materials, rungs that change in contact. The force is finite,
// never longer or more tilted than the law lets it be, changes in a tick by no more than the law does for the
// step of the hand, and stands still with the hand.
//
// What the law allows. With slope g = grad H, F is k d, k [(d - H) n + H m] or k d (n - g) long and wide:
// along a step s it changes by k s for the depth, by k d |change of g| for the turn of m (m(g) is
// 1-Lipschitz, and so is the compression), and by k |change of H| |m - n| for the height.

#include "tests/stability/trial.h"
#include "tests/support/test_shapes.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace touchstone::test {
namespace {

constexpr double kPi = 3.141592653589793, kStiffness = 1000.0, kSide = 0.1; // N/m, m
constexpr TextureMode kRungs[] = {TextureMode::Law, TextureMode::Blinn, TextureMode::Minsky};

HapticSettings felt(TextureMode mode, double radius = 0.0) {
    HapticSettings s = Variant{radius, true}.settings();
    s.texture = mode;
    return s;
}

/// A plane of 0.1 m with a height map of `scale` m.
Scene reliefPlane(const Image& heights, double scale, int cells = 4) {
    Scene scene;
    scene.materials.emplace_back();
    scene.images.push_back(heights);
    HeightMap map;
    map.texture = texture(0);
    map.scale = static_cast<float>(scale);
    scene.materials[0].haptic.height = {map, HapticSource::Touchstone};
    place(scene, quadMesh(0.5 * kSide, cells), 0);
    return scene;
}

Image slopeImage(int texels) {
    return image("slope", texels, texels, 1,
                 [](double u, double) { return glm::vec4(static_cast<float>(u)); });
}

/// Follows a hand: finite, no longer than k d (Minsky: its normal part), no steeper than the cap, and the
/// change in a tick against what `allowed` grants for the step.
struct Watch {
    explicit Watch(const TouchBench& on) : bench(on) {}

    const TouchBench& bench;
    double worst = 0.0, largest = 0.0; ///< change over allowed; N
    int ticks = 0, compressed = 0;
    bool first = true;
    HapticOutput last;

    void take(const HapticOutput& out, double allowed) {
        ASSERT_TRUE(std::isfinite(out.force.x + out.force.y + out.force.z));
        ++ticks;
        compressed += has(out.flags, TickFlag::TiltCompressed) ? 1 : 0;
        const double d = out.penetration, cap = bench.settings.textureTiltLimit;
        const double longest = bench.settings.texture == TextureMode::Minsky ? d / std::cos(cap) : d;
        EXPECT_LE(glm::length(out.force), kStiffness * longest * (1.0 + 1e-9) + 1e-12);
        if (!first) {
            const double change = glm::length(out.force - last.force);
            largest = std::max(largest, change);
            worst = std::max(worst, change / allowed);
            EXPECT_LE(change, allowed) << "tick " << ticks;
        }
        first = false;
        last = out;
    }
};

double held(TouchBench& bench) {
    for (int i = 0; i < 300; ++i) // the filtered speed falls, and with it the mip level
        bench.step(bench.output.hip);
    return holdStill(bench, 100);
}

TEST(TextureStability, CliffsOfOneTexel) {
    constexpr int kTexels = 128;
    const double scale = 5e-4, texel = kSide / kTexels;
    const Image cliffs = image("cliffs", kTexels, kTexels, 1, [](double u, double v) {
        const int x = static_cast<int>(u * kTexels), y = static_cast<int>(v * kTexels);
        return glm::vec4(static_cast<float>((x + y) % 2));
    });
    for (const TextureMode mode : kRungs)
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

TEST(TextureStability, ASeamOfTheCoordinatesIsNotFelt) {
    // Waves that fit round the torus: over the seams of u and of v the force changes as it does elsewhere.
    for (const TextureMode mode : kRungs)
        for (const bool along : {true, false}) {
            const double ring = 0.06, tube = 0.025, scale = 4e-4;
            Scene scene = reliefPlane(image("waves", 256, 256, 1,
                                            [](double u, double v) {
                                                return glm::vec4(
                                                    static_cast<float>(0.5 + 0.25 * std::sin(16.0 * kPi * u) +
                                                                       0.25 * std::sin(8.0 * kPi * v)));
                                            }),
                                      scale);
            Scene torus;
            torus.materials = scene.materials;
            torus.images = scene.images;
            place(torus, torusMesh(ring, tube, 180, 90, {1.0f, 1.0f}), 0);
            TouchBench bench(torus, felt(mode));
            const auto hip = [&](double turn, double depth) {
                const double phi = along ? turn : 0.7, theta = along ? 0.4 : turn,
                             reach = ring + (tube - depth) * std::cos(theta);
                return glm::dvec3(reach * std::sin(phi), (tube - depth) * std::sin(theta),
                                  reach * std::cos(phi));
            };
            for (int i = 0; i <= 100; ++i)
                bench.step(hip(-0.3, -0.002 + 3e-5 * i));
            double atSeam = 0.0, elsewhere = 0.0;
            const double stride = 0.002;
            HapticOutput last = bench.output;
            for (int i = 0; i <= 1000; ++i) {
                const double turn = -0.3 + stride * i;
                const HapticOutput& out = bench.step(hip(turn, 1e-3));
                ASSERT_TRUE(std::isfinite(out.force.x + out.force.y + out.force.z));
                double& most = std::abs(turn) < 0.02 ? atSeam : elsewhere;
                if (i > 20)
                    most = std::max(most, glm::length(out.force - last.force));
                last = out;
            }
            EXPECT_LT(atSeam, 1.05 * elsewhere);
            EXPECT_GT(elsewhere, 1e-3);
        }
}

TEST(TextureStability, MirroredCoordinatesTurnTheSlopeAtTheirLineAndNowhereElse) {
    // u = |x|: on both sides of x = 0 the ground rises outwards by the same slope.
    const double scale = 0.02, slope = scale / kSide;
    for (const TextureMode mode : kRungs) {
        Scene scene = reliefPlane(slopeImage(256), scale, 8);
        for (size_t v = 0; v < scene.meshes[0].uv0.size(); ++v)
            scene.meshes[0].uv0[v].x =
                0.25f + static_cast<float>(std::abs(scene.meshes[0].positions[v].x) / kSide);
        HapticSettings s = felt(mode);
        s.textureTiltLimit = 0.5 * kPi;
        TouchBench bench(scene, s);
        bench.step({-0.03, 0.003, 0.01});
        bench.moveTo({-0.03, 0.003, -1e-3}, 0.05);
        double last = bench.output.force.x;
        int turns = 0;
        bench.moveTo({0.03, 0.004, -1e-3}, 0.03, [&](const HapticOutput& out) {
            const double d = out.penetration, g = std::copysign(slope, out.proxy.x);
            const double along = mode == TextureMode::Minsky ? 1.0 : 1.0 / std::sqrt(1.0 + slope * slope);
            EXPECT_NEAR(out.force.x, -kStiffness * d * g * along, 0.01 * kStiffness * d * slope)
                << out.proxy.x;
            turns += (out.force.x < 0.0) != (last < 0.0) ? 1 : 0;
            last = out.force.x;
        });
        EXPECT_EQ(turns, 1);
        EXPECT_EQ(held(bench), 0.0);
    }
}

TEST(TextureStability, CollapsedCoordinatesHaveTheSlopeThatIsLeft) {
    const double scale = 0.02;
    for (const TextureMode mode : kRungs)
        for (const double width : {0.0, 1e-9, 1.0}) { // of v; u is whole or nothing
            for (const bool anyU : {false, true}) {
                Scene scene = reliefPlane(slopeImage(256), scale, 3);
                for (glm::vec2& uv : scene.meshes[0].uv0)
                    uv = {anyU ? 0.2f + 0.5f * uv.x : 0.4f, static_cast<float>(width) * uv.y};
                scene.meshes[0].tangents.clear();
                TouchBench bench(scene, felt(mode));
                bench.step({-0.03, 0.003, 0.01});
                bench.moveTo({-0.03, 0.003, -1e-3}, 0.05);
                double most = 0.0;
                bench.moveTo({0.03, 0.013, -1e-3}, 0.05, [&](const HapticOutput& out) {
                    ASSERT_TRUE(std::isfinite(out.force.x + out.force.y + out.force.z));
                    const double expected = anyU ? -0.5 * scale / kSide : 0.0;
                    EXPECT_NEAR(out.force.x / out.force.z, expected, 1e-3);
                    EXPECT_NEAR(out.force.y / out.force.z, 0.0, 1e-6);
                    most = std::max(most, std::abs(out.force.x));
                });
                EXPECT_EQ(most > 0.0, anyU);
                EXPECT_EQ(held(bench), 0.0);
            }
        }
}

/// A plane with a normal map that leans by 20 degrees everywhere.
Scene leaning() {
    Scene scene;
    scene.materials.emplace_back();
    scene.images.push_back(image("lean", 4, 4, 3, [](double, double) {
        const glm::dvec3 n = glm::normalize(glm::dvec3(std::tan(20.0 * kPi / 180.0), 0.1, 1.0));
        return glm::vec4(glm::vec3(0.5 + 0.5 * n), 1.0f);
    }));
    scene.materials[0].normalTexture = texture(0);
    place(scene, quadMesh(0.5 * kSide, 4), 0);
    return scene;
}

TEST(TextureStability, TangentsThatAreZeroOrCancelLeaveTheNormal) {
    for (const bool cancel : {false, true}) {
        Scene scene = leaning();
        Mesh& mesh = scene.meshes[0];
        for (size_t v = 0; v < mesh.tangents.size(); ++v)
            mesh.tangents[v] = cancel ? glm::vec4(v % 2 == 0 ? 1.0f : -1.0f, 0, 0, v % 3 == 0 ? -1.0f : 1.0f)
                                      : glm::vec4(0, 0, 0, 1);
        TouchBench bench(scene, felt(TextureMode::Law));
        Watch watch(bench);
        bench.step({-0.03, 0.003, 0.01});
        bench.moveTo({-0.03, 0.003, -1e-3}, 0.05);
        // The interpolated tangent turns right round where it cancels: m by twice the lean at most.
        const double allowed = kStiffness * (5e-5 + 2e-3 * std::sin(25.0 * kPi / 180.0));
        bench.moveTo({0.03, 0.013, -1e-3}, 0.05, [&](const HapticOutput& out) {
            watch.take(out, allowed);
            if (!cancel) {
                EXPECT_NEAR(glm::length(glm::dvec2(out.force.x, out.force.y)), 0.0, 1e-9);
            }
        });
        EXPECT_EQ(held(bench), 0.0);
    }
}

TEST(TextureStability, ANodeThatMirrorsAndStretchesIsTheSameSurfaceAsItsVertices) {
    for (const glm::dvec3& by :
         {glm::dvec3(-1, 1, 1), glm::dvec3(1, -0.5, 1), glm::dvec3(-2, 0.5, 1.5), glm::dvec3(-1, -1, -1)})
        for (const bool normalMap : {false, true})
            for (const TextureMode mode : kRungs) {
                const bool mirrored = by.x * by.y * by.z < 0.0;
                const Scene plain = normalMap ? leaning() : reliefPlane(slopeImage(64), 0.01, 5);
                Scene byNode, byVertices;
                byNode.materials = byVertices.materials = plain.materials;
                byNode.images = byVertices.images = plain.images;
                Mesh mesh = plain.meshes[0];
                place(byNode, mesh, 0, glm::dmat4(glm::dmat3(by.x, 0, 0, 0, by.y, 0, 0, 0, by.z)));
                for (size_t v = 0; v < mesh.positions.size(); ++v) {
                    mesh.positions[v] *= glm::vec3(by);
                    mesh.normals[v] = glm::normalize(mesh.normals[v] / glm::vec3(by));
                    mesh.tangents[v] = glm::vec4(glm::normalize(glm::vec3(mesh.tangents[v]) * glm::vec3(by)),
                                                 mirrored ? -mesh.tangents[v].w : mesh.tangents[v].w);
                }
                for (size_t t = 0; mirrored && t < mesh.indices.size(); t += 3)
                    std::swap(mesh.indices[t + 1], mesh.indices[t + 2]);
                place(byVertices, mesh, 0);
                TouchBench a(byNode, felt(mode)), b(byVertices, felt(mode));
                double most = 0.0, apart = 0.0;
                for (int i = 0; i <= 300; ++i) {
                    const glm::dvec3 hip(-0.02 + 1e-4 * i, 0.01,
                                         by.z > 0.0 ? 0.002 - 1e-5 * i : -0.002 + 1e-5 * i);
                    const glm::dvec3 fa = a.step(hip).force, fb = b.step(hip).force;
                    apart = std::max(apart, glm::length(fa - fb));
                    most = std::max(most, std::abs(fa.x));
                }
                EXPECT_LT(apart, 1e-4 * most);
                EXPECT_GT(most, 0.01);
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

TEST(TextureStability, ABorderBetweenMaterialsChangesTheForceByTheirDifference) {
    const double scale = 0.02, slope = scale / kSide;
    for (const TextureMode mode : kRungs) {
        Scene scene = reliefPlane(slopeImage(256), scale);
        scene.materials[0].haptic.height.value->texture.wrapS =
            Wrap::ClampToEdge; // else the map has a cliff there
        scene.materials.emplace_back();
        place(scene, quadMesh(0.5 * kSide, 4), 1, glm::translate(glm::dmat4(1.0), glm::dvec3(kSide, 0, 0)));
        TouchBench bench(scene, felt(mode));
        const double speed = 0.05, s = speed * bench.dt, depth = 1e-3;
        bench.step({0.03, 0.003, 0.01});
        bench.moveTo({0.03, 0.003, -depth}, 0.05);
        Watch watch(bench);
        watch.take(bench.output, 1.0);
        // m - n is no longer than the slope; Minsky's is the slope.
        const double border = kStiffness * (s + (depth + 1e-6) * slope);
        double lean = 0.0;
        bench.moveTo({0.07, 0.003, -depth}, speed, [&](const HapticOutput& out) {
            watch.take(out, border);
            if (out.proxy.x < 0.5 * kSide - 1e-3) {
                lean = std::max(lean, -out.force.x);
            } else if (out.proxy.x > 0.5 * kSide + 1e-3) {
                EXPECT_NEAR(out.force.x, 0.0, 1e-9) << "nothing of the other material is left";
            }
        });
        EXPECT_GT(lean, 0.9 * kStiffness * depth * slope);
        bench.moveTo({0.5 * kSide, 0.003, -depth}, speed); // held on the very border
        EXPECT_EQ(held(bench), 0.0);
    }
}

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
            for (const TextureMode mode : kRungs) {
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
} // namespace touchstone::test

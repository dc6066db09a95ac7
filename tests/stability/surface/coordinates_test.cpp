// Coordinates and frames at their worst: seams, mirrored and collapsed coordinates, tangents that are zero or
// cancel, nodes that mirror and stretch.

#include "tests/stability/surface/touched_plane.h"

#include <algorithm>
#include <cmath>

namespace touchstone::test::coordinates_test {
namespace {

/// Waves that fit round the torus, felt as one of these.
enum class SeamMap { Heights, Normals, NormalsWithoutTangents, Stiffness, Friction };

Scene wavyTorus(SeamMap kind, double ring, double tube) {
    const auto wave = [](double u, double v) {
        return 0.5 + 0.25 * std::sin(16.0 * kPi * u) + 0.25 * std::sin(8.0 * kPi * v);
    };
    const auto lean = [](double u, double v) {
        return glm::normalize(glm::dvec3(0.2 * std::cos(16.0 * kPi * u), 0.2 * std::cos(8.0 * kPi * v), 1.0));
    };
    const bool normals = kind == SeamMap::Normals || kind == SeamMap::NormalsWithoutTangents;
    Scene scene;
    scene.materials.emplace_back();
    Material& material = scene.materials[0];
    scene.images.push_back(image("waves", 256, 256, normals ? 3 : 1, [&](double u, double v) {
        return normals ? glm::vec4(0.5 + 0.5 * lean(u, v), 1.0) : glm::vec4(static_cast<float>(wave(u, v)));
    }));
    FactorMap factor;
    factor.texture = texture(0);
    factor.min = 0.3f;
    HeightMap heights;
    heights.texture = texture(0);
    heights.scale = 4e-4f;
    if (normals)
        material.normalTexture = texture(0);
    else if (kind == SeamMap::Heights)
        material.haptic.height = {heights, HapticSource::Touchstone};
    else if (kind == SeamMap::Stiffness)
        material.haptic.stiffnessMap = {factor, HapticSource::Touchstone};
    else
        material.haptic.friction = {factor, HapticSource::Touchstone};
    material.haptic.staticFriction = material.haptic.dynamicFriction = {0.5f, HapticSource::Touchstone};
    Mesh torus = torusMesh(ring, tube, 180, 90, {1.0f, 1.0f});
    if (kind == SeamMap::NormalsWithoutTangents)
        torus.tangents.clear();
    place(scene, torus, 0);
    return scene;
}

/// Over the seam of u (`along`) or of v the force changes as it does elsewhere.
void strokeOverSeam(SeamMap kind, const HapticSettings& settings, bool along) {
    SCOPED_TRACE(std::to_string(static_cast<int>(kind)) + " texture=" + settingValue(settings, "texture") +
                 (along ? " along u" : " along v"));
    const double ring = 0.06, tube = 0.025;
    TouchBench bench(wavyTorus(kind, ring, tube), settings);
    const auto hip = [&](double turn, double depth) {
        const double phi = along ? turn : 0.7, theta = along ? 0.4 : turn,
                     reach = ring + (tube - depth) * std::cos(theta);
        return glm::dvec3(reach * std::sin(phi), (tube - depth) * std::sin(theta), reach * std::cos(phi));
    };
    for (int i = 0; i <= 100; ++i)
        bench.step(hip(-0.3, -0.002 + 3e-5 * i));
    double atSeam = 0.0, elsewhere = 0.0, least = INFINITY, most = 0.0;
    const double stride = 0.002;
    HapticOutput last = bench.output;
    for (int i = 0; i <= 1000; ++i) {
        const double turn = -0.3 + stride * i;
        const HapticOutput& out = bench.step(hip(turn, 1e-3));
        ASSERT_TRUE(std::isfinite(out.force.x + out.force.y + out.force.z));
        double& change = std::abs(turn) < 0.02 ? atSeam : elsewhere;
        if (i > 50) { // pressed in, the filter settled, and what sticks slides
            change = std::max(change, glm::length(out.force - last.force));
            least = std::min(least, glm::length(out.force));
            most = std::max(most, glm::length(out.force));
        }
        last = out;
    }
    EXPECT_LT(atSeam, 1.05 * elsewhere);
    EXPECT_GT(elsewhere, 1e-3);
    if (kind == SeamMap::Stiffness) {
        EXPECT_GT(most, 1.3 * least);
    }
    EXPECT_EQ(held(bench), 0.0);
}

TEST(TextureStability, ASeamOfTheCoordinatesIsNotFelt) {
    for (const bool along : {true, false}) {
        for (const TextureMode mode : kConfigurations)
            strokeOverSeam(SeamMap::Heights, felt(mode), along);
        for (const SeamMap kind : {SeamMap::Normals, SeamMap::NormalsWithoutTangents, SeamMap::Stiffness})
            strokeOverSeam(kind, felt(TextureMode::Law), along);
        HapticSettings sliding = felt(TextureMode::Law);
        sliding.friction = FrictionMode::Ho;
        strokeOverSeam(SeamMap::Friction, sliding, along);
    }
}

TEST(TextureStability, MirroredCoordinatesTurnTheSlopeAtTheirLineAndNowhereElse) {
    // u = |x|: on both sides of x = 0 the ground rises outwards by the same slope.
    const double scale = 0.02, slope = scale / kSide;
    for (const TextureMode mode : kConfigurations) {
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
    for (const TextureMode mode : kConfigurations)
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
                constexpr double kRounding = 1e-12; // N; which code is inlined decides its last bits
                EXPECT_EQ(most > kRounding, anyU) << most;
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
            for (const TextureMode mode : kConfigurations) {
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

} // namespace
} // namespace touchstone::test::coordinates_test

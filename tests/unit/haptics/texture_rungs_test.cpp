// The ways in which heights become force, and where heights come from: vertex attributes, the virtual bump.

#include "engine/load/scene_loader.h"
#include "tests/support/test_shapes.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace touchstone::test::texture_rungs_test {
namespace {

constexpr double kPi = 3.141592653589793, kStiffness = 1000.0;

HapticSettings uncapped(TextureMode mode) {
    HapticSettings s;
    s.texture = mode;
    s.friction = FrictionMode::Off;
    s.stiffness = kStiffness;
    s.textureTiltLimit = 0.5 * kPi;
    return s;
}

/// A slope of constant gradient as an image of floats, `g` heights a texture.
Image ramp(const glm::dvec2& g, int size = 64) {
    Image image;
    image.decoded = true;
    image.pixels = {size, size, 1, ComponentType::F32, {}};
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const auto h = static_cast<float>(g.x * (x + 0.5) / size + g.y * (y + 0.5) / size);
            const auto* bytes = reinterpret_cast<const std::byte*>(&h);
            image.pixels.bytes.insert(image.pixels.bytes.end(), bytes, bytes + sizeof h);
        }
    return image;
}

/// [001 4.11] as it is printed, with N = P_s x P_t turned outwards and the bump along it.
glm::dvec3 printedBlinn(const glm::dvec3& ps, const glm::dvec3& pt, double bs, double bt,
                        const glm::dvec3& outside) {
    const glm::dvec3 n = glm::cross(ps, pt);
    const double side = glm::dot(n, outside) < 0.0 ? -1.0 : 1.0;
    const glm::dvec3 bumped = n + side * (bs * glm::cross(n, pt) - bt * glm::cross(n, ps)) / glm::length(n);
    return side * glm::normalize(bumped);
}

TEST(TextureRungs, BlinnsNormalIsTheOneThatIsPrinted) {
    // Sheared, stretched and mirrored coordinates: the formula is evaluated in them, the product in the
    // triangle's own.
    const double scale = 0.01;
    for (const glm::dmat2& xyFromUv : {glm::dmat2(0.2, 0.0, 0.0, -0.2), glm::dmat2(0.2, 0.0, 0.0, 0.2),
                                       glm::dmat2(0.3, 0.05, 0.1, -0.15)}) {
        Mesh mesh = quadMesh(0.1, 3);
        const glm::dmat2 uvFromXy = glm::inverse(xyFromUv);
        for (size_t v = 0; v < mesh.positions.size(); ++v)
            mesh.uv0[v] = glm::vec2(uvFromXy * glm::dvec2(mesh.positions[v].x, mesh.positions[v].y) + 0.5);
        mesh.tangents.clear();
        Scene scene;
        scene.materials.emplace_back();
        const glm::dvec2 slope(0.6, -0.4);
        scene.images.push_back(ramp(slope));
        HeightMap map;
        map.texture = texture(0);
        map.texture.wrapS = map.texture.wrapT = Wrap::ClampToEdge;
        map.scale = static_cast<float>(scale);
        scene.materials[0].haptic.height = {map, HapticSource::Touchstone};
        place(scene, mesh, 0);
        TouchBench bench(scene, uncapped(TextureMode::Blinn));
        bench.step({0.004, -0.003, 0.01});
        for (int i = 0; i < 100; ++i)
            bench.step({0.004, -0.003, 0.01 - 1.1e-4 * i});
        const glm::dvec3 ps(xyFromUv[0], 0.0), pt(xyFromUv[1], 0.0);
        const glm::dvec3 m = printedBlinn(ps, pt, scale * slope.x, scale * slope.y, {0, 0, 1});
        const glm::dvec3 expected = kStiffness * bench.output.penetration * m;
        EXPECT_LT(glm::length(bench.output.force - expected), 1e-4 * glm::length(expected));
        EXPECT_GT(std::abs(m.x) + std::abs(m.y), 0.02);
    }
}

/// A plane of `cells` with the height a x + b y at its vertices, model metres, and no texture coordinates.
Scene tilted(double a, double b, int cells) {
    Scene scene;
    scene.materials.emplace_back();
    Mesh mesh = quadMesh(0.1, cells);
    mesh.uv0.clear();
    mesh.tangents.clear();
    for (const glm::vec3& p : mesh.positions)
        mesh.heights.push_back(
            static_cast<float>(a * static_cast<double>(p.x) + b * static_cast<double>(p.y)));
    place(scene, mesh, 0);
    return scene;
}

TEST(VertexHeights, GiveTheNormalOfThe3DGradientWithoutTextureCoordinates) {
    const glm::dvec3 slope(0.15, -0.1, 0.0), n(0, 0, 1);
    const double lowest = -0.1 * 0.15 - 0.1 * 0.1;
    for (const double side : {1.0, -1.0})
        for (const TextureMode mode : {TextureMode::Law, TextureMode::Blinn, TextureMode::Minsky}) {
            TouchBench bench(tilted(slope.x, slope.y, 5), uncapped(mode));
            const glm::dvec3 at(-0.09, 0.085, 0.0);
            bench.step(at + glm::dvec3(0, 0, 0.01 * side));
            for (int i = 0; i <= 110; ++i)
                bench.step(at + glm::dvec3(0, 0, side * (0.01 - 2e-4 * i)));
            const double d = bench.output.penetration;
            // From behind the bump height is the same surface: its highest place is the lowest there.
            const double above = glm::dot(slope, at) - lowest;
            const double h = side > 0.0 ? above : -2.0 * lowest - above;
            const glm::dvec3 m = side * glm::normalize(n - slope);
            glm::dvec3 expected = kStiffness * d * m;
            if (mode == TextureMode::Law && d >= h)
                expected = kStiffness * ((d - h) * side * n + h * m);
            if (mode == TextureMode::Minsky)
                expected = kStiffness * d * side * (n - slope);
            EXPECT_LT(glm::length(bench.output.force - expected), 1e-3 * glm::length(expected))
                << static_cast<int>(mode) << " side " << side;
            EXPECT_NEAR(bench.output.height, h, 1e-6);
        }
}

/// The plane of `tilted` pressed `depth` deep at `at` from the side of `side`.
const HapticOutput& press(TouchBench& bench, const glm::dvec3& at, double side, double depth) {
    bench.step(at + glm::dvec3(0, 0, 0.01 * side));
    for (int i = 1; i <= 100; ++i)
        bench.step(at + glm::dvec3(0, 0, side * (0.01 - (0.01 + depth) * 0.01 * i)));
    return bench.output;
}

TEST(BlinnMagnitude, FollowsTheEntryOfTheBumpMapAlongBlinnsNormal) {
    // [001 §4.3.2]: "the magnitude of the feedback force vector can be increased or decreased slightly
    // depending on the entry in the bump map": k (d + B), and no pull where a dent is deeper than the hand.
    const glm::dvec3 slope(0.05, -0.03, 0.0), n(0, 0, 1);
    int higher = 0, lower = 0, none = 0;
    for (const double side : {1.0, -1.0})
        for (const glm::dvec3 at :
             {glm::dvec3(0.07, -0.06, 0), glm::dvec3(-0.02, 0.01, 0), glm::dvec3(-0.07, 0.08, 0)})
            for (const double depth : {5e-4, 2e-3, 8e-3}) {
                TouchBench bench(tilted(slope.x, slope.y, 5), uncapped(TextureMode::BlinnMagnitude));
                const HapticOutput& out = press(bench, at, side, depth);
                const double bump = side * glm::dot(slope, at),
                             raised = std::max(out.penetration + bump, 0.0);
                const glm::dvec3 expected = kStiffness * raised * side * glm::normalize(n - slope);
                EXPECT_LT(glm::length(out.force - expected), 1e-6 + 1e-5 * glm::length(expected))
                    << "side " << side << ", depth " << depth;
                higher += bump > 1e-3;
                lower += bump < -1e-3;
                none += raised == 0.0;
            }
    EXPECT_GT(higher, 0);
    EXPECT_GT(lower, 0);
    EXPECT_GT(none, 0);
}

TEST(BlinnMagnitude, StepsByTheBumpWhereContactBegins) {
    // What it is worse at than the displacement law: the force does not begin at nothing.
    const glm::dvec3 at(0.06, -0.05, 0.0), slope(0.05, -0.03, 0.0);
    const double bump = glm::dot(slope, at);
    for (const TextureMode mode : {TextureMode::BlinnMagnitude, TextureMode::Law}) {
        TouchBench bench(tilted(slope.x, slope.y, 5), uncapped(mode));
        bench.step(at + glm::dvec3(0, 0, 1e-3));
        double first = 0.0;
        for (double z = 1e-3; first == 0.0; z -= 1e-6)
            first = glm::length(bench.step(at + glm::dvec3(0, 0, z)).force);
        if (mode == TextureMode::Law)
            EXPECT_LT(first, 2.1e-6 * kStiffness);
        else
            EXPECT_NEAR(first, kStiffness * bump, 2.1e-6 * kStiffness);
    }
    EXPECT_GT(kStiffness * bump, 4.0);
}

TEST(BlinnMagnitude, CountsFromTheMapsMidLevel) {
    for (const double mid : {0.5, 0.2}) {
        Scene scene;
        scene.materials.emplace_back();
        scene.images.push_back(ramp({0.6, 0.0}));
        HeightMap map;
        map.texture = texture(0);
        map.texture.wrapS = map.texture.wrapT = Wrap::ClampToEdge;
        map.scale = 2e-3f;
        map.midLevel = static_cast<float>(mid);
        scene.materials[0].haptic.height = {map, HapticSource::Touchstone};
        place(scene, quadMesh(0.1, 3), 0);
        TouchBench bench(scene, uncapped(TextureMode::BlinnMagnitude));
        const HapticOutput& out = press(bench, {0.02, 0.0, 0.0}, 1.0, 2e-3);
        // u = 0.6 there, so the map says 0.36; the slope is 2 mm * 0.6 over 0.2 m.
        const double bump = 2e-3 * (0.36 - mid);
        EXPECT_NEAR(glm::length(out.force), kStiffness * (out.penetration + bump), 1e-4) << mid;
    }
}

TEST(BlinnMagnitude, WithoutBumpIsBlinnAndTheNormalAsPrintedIsMinskys) {
    // [001 4.11] is not of unit length: k d N_new / |N| leaves the normal force as it is and adds the slope,
    // which is texture=minsky to the last digits. So there is no other law in it.
    const glm::dvec3 at(-0.09, 0.085, 0.0), slope(0.15, -0.1, 0.0);
    TouchBench minsky(tilted(slope.x, slope.y, 5), uncapped(TextureMode::Minsky));
    const HapticOutput& out = press(minsky, at, 1.0, 2e-3);
    const glm::dvec3 ps(0.3, 0.05, 0.0), pt(-0.1, 0.2, 0.0), n = glm::cross(ps, pt);
    const glm::dvec3 printed =
        n +
        (glm::dot(slope, ps) * glm::cross(n, pt) - glm::dot(slope, pt) * glm::cross(n, ps)) / glm::length(n);
    const glm::dvec3 expected = kStiffness * out.penetration * printed / glm::length(n);
    EXPECT_LT(glm::length(out.force - expected), 1e-5 * glm::length(expected));

    TouchBench flat(tilted(0.0, 0.0, 5), uncapped(TextureMode::BlinnMagnitude));
    TouchBench blinn(tilted(0.0, 0.0, 5), uncapped(TextureMode::Blinn));
    EXPECT_EQ(press(flat, at, 1.0, 2e-3).force, press(blinn, at, 1.0, 2e-3).force);
}

TEST(VertexHeights, AreFeltSmoothWhereTheSurfaceIs) {
    // A paraboloid of heights on a flat mesh: the gradient between vertices follows it, without a jump at an
    // edge; with shading off it is the facet's.
    const double curvature = 4.0; // 1/m
    Scene scene = tilted(0.0, 0.0, 20);
    Mesh& mesh = scene.meshes[0];
    for (size_t v = 0; v < mesh.positions.size(); ++v)
        mesh.heights[v] = static_cast<float>(
            0.5 * curvature * glm::dot(glm::dvec3(mesh.positions[v]), glm::dvec3(mesh.positions[v])));
    double jump[2] = {}, error[2] = {};
    for (const bool smooth : {false, true}) {
        HapticSettings s = uncapped(TextureMode::Minsky);
        s.forceShading = smooth ? ShadingMode::TwoPass : ShadingMode::Off;
        TouchBench bench(scene, s);
        bench.step({-0.06, 0.013, 0.01});
        bench.moveTo({-0.06, 0.013, -0.002}, 0.1);
        glm::dvec3 last = bench.output.force;
        bench.moveTo({0.06, 0.017, -0.002}, 0.1, [&](const HapticOutput& out) {
            const double d = out.penetration;
            jump[smooth] = std::max(jump[smooth], glm::length(out.force - last));
            error[smooth] =
                std::max(error[smooth], std::abs(out.force.x + kStiffness * d * curvature * out.proxy.x));
            last = out.force;
        });
    }
    // On facets the gradient steps by the curvature times their width, 40 mN times 2; between vertices it
    // turns by 2 N * curvature * 0.1 mm a tick.
    EXPECT_GT(jump[0], 0.05);
    EXPECT_LT(jump[1], 2e-3);
    EXPECT_GT(error[0], 0.02);
    EXPECT_LT(error[1], 1e-3);
}

TEST(VirtualBump, APlaneThatFeelsCurvedByItsLateralForce) {
    const ScenePtr scene = loadScene(std::string(TOUCHSTONE_ASSETS) + "/virtual_bump.glb");
    const double height = 0.006, radius = 0.045, depth = 0.002;
    const auto slopeAt = [&](double r) {
        return r < radius ? -0.5 * height * kPi / radius * std::sin(kPi * r / radius) : 0.0;
    };
    for (const TextureMode mode : {TextureMode::Law, TextureMode::Blinn, TextureMode::Minsky}) {
        TouchBench bench(*scene, uncapped(mode));
        bench.step({-0.06, 0.01, 0.004});
        bench.moveTo({-0.06, -depth, 0.004}, 0.05);
        double most = 0.0;
        bench.moveTo({0.06, -depth, 0.004}, 0.05, [&](const HapticOutput& out) {
            EXPECT_LT(std::abs(out.proxy.y), 1e-6) << "the plane stays flat";
            const glm::dvec2 from(out.hip.x, out.hip.z);
            const double r = glm::length(from), slope = slopeAt(r), d = out.penetration;
            const double h = r < radius ? height * (0.5 + 0.5 * std::cos(kPi * r / radius)) : 0.0;
            const double along = mode == TextureMode::Minsky ? 1.0 : 1.0 / std::sqrt(1.0 + slope * slope);
            const double shared = mode == TextureMode::Law ? std::min(d, h) : d;
            const glm::dvec2 expected = -kStiffness * shared * slope * along * from / r;
            EXPECT_LT(glm::length(glm::dvec2(out.force.x, out.force.z) - expected), 0.005)
                << "at " << r << " m, mode " << static_cast<int>(mode);
            if (mode == TextureMode::Minsky) {
                EXPECT_NEAR(out.force.y, kStiffness * d, 1e-9) << "no more and no less than the plane";
            }
            most = std::max(most, glm::length(expected));
        });
        EXPECT_GT(most, 0.3);
    }
}

} // namespace
} // namespace touchstone::test::texture_rungs_test

// The sine bump height on a plane, a sphere and a torus: against the formulas evaluated here in long double
// on the same mesh, and against the smooth shapes.

#include "tests/support/test_shapes.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace touchstone::test::texture_law_test {
namespace {

using Real = long double;
using Vec = glm::tvec3<Real>;
using Uv = glm::tvec2<Real>;

constexpr Real kTau = 6.283185307179586476925L;
constexpr double kStiffness = 1000.0;
constexpr int kWavesU = 6, kWavesV = 4, kTexels = 2048;

/// Height of the bump height and its derivatives, in parts of `scale` and of the texture.
struct Sine {
    Real value, du, dv;
};
Sine sineAt(const Uv& uv) {
    const Real a = kTau * kWavesU * uv.x, b = kTau * kWavesV * uv.y;
    return {0.5L + 0.25L * (std::sin(a) + std::sin(b)), 0.25L * kTau * kWavesU * std::cos(a),
            0.25L * kTau * kWavesV * std::cos(b)};
}

/// The four laws, written from the papers. `slope` is grad H; the map's middle lies on the mesh.
Vec lawForce(TextureMode mode, const Vec& n, Real d, Real height, Real middle, const Vec& slope) {
    const Vec m = glm::normalize(n - slope + glm::dot(slope, n) * n);
    const auto k = static_cast<Real>(kStiffness);
    switch (mode) {
    case TextureMode::Law:
        return k * (d >= height ? (d - height) * n + height * m : d * m);
    case TextureMode::Blinn:
        return k * d * m;
    case TextureMode::Minsky:
        return k * d * n - k * d * (slope - glm::dot(slope, n) * n);
    case TextureMode::BlinnMagnitude:
        return k * std::max(d + height - middle, 0.0L) * m;
    case TextureMode::Off:
        break;
    }
    return k * d * n;
}

/// A shape with its mesh and its closed form; u, v as the mesh has them.
struct Body {
    const char* name;
    Mesh mesh;
    Real heightScale;                    ///< m, black to white
    std::function<Vec(const Uv&)> point; ///< m
    std::function<Uv(const Vec&)> below; ///< where the surface is nearest
    Uv from{0.0L}, to{1.0L};             ///< what is touched
};

Vec partial(const Body& body, Uv uv, int axis) {
    const Real step = 1e-6L;
    Uv lower = uv, upper = uv;
    lower[axis] -= step;
    upper[axis] += step;
    return (body.point(upper) - body.point(lower)) / (2.0L * step);
}

Body planeBody(int cells, double size) {
    const auto s = static_cast<Real>(size);
    return {"plane",
            quadMesh(0.1 * size, cells),
            2e-3L * s,
            [s](const Uv& t) { return Vec(0.2L * s * (t.x - 0.5L), 0.2L * s * (0.5L - t.y), 0.0L); },
            [s](const Vec& p) { return Uv(p.x / (0.2L * s) + 0.5L, 0.5L - p.y / (0.2L * s)); },
            Uv(0.2L),
            Uv(0.8L)};
}

Body sphereBody(int cells, double size) {
    const Real radius = 0.05L * static_cast<Real>(size);
    return {"sphere",
            sphereMesh(0.05 * size, 2 * cells, cells),
            0.02L * radius,
            [radius](const Uv& t) {
                const Real phi = kTau * t.x, theta = 0.5L * kTau * t.y;
                return radius *
                       Vec(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi));
            },
            [](const Vec& p) {
                const Real phi = std::atan2(p.x, p.z) / kTau;
                return Uv(phi < 0.0L ? phi + 1.0L : phi, 2.0L * std::acos(p.y / glm::length(p)) / kTau);
            },
            Uv(0.03L, 0.25L),
            Uv(0.97L, 0.75L)}; // away from the poles, where u has no gradient
}

Body torusBody(int cells, double size) {
    const Real ring = 0.06L * static_cast<Real>(size), tube = 0.025L * static_cast<Real>(size);
    return {"torus",
            torusMesh(0.06 * size, 0.025 * size, 2 * cells, cells, {1.0f, 1.0f}),
            0.04L * tube,
            [=](const Uv& t) {
                const Real phi = kTau * t.x, theta = -kTau * t.y, reach = ring + tube * std::cos(theta);
                return Vec(reach * std::sin(phi), tube * std::sin(theta), reach * std::cos(phi));
            },
            [=](const Vec& p) {
                const Real phi = std::atan2(p.x, p.z) / kTau,
                           theta = -std::atan2(p.y, std::sqrt(p.x * p.x + p.z * p.z) - ring) / kTau;
                return Uv(phi < 0.0L ? phi + 1.0L : phi, theta < 0.0L ? theta + 1.0L : theta);
            },
            Uv(0.0L),
            Uv(1.0L)};
}

Image sineImage() {
    Image image;
    image.name = "sine";
    image.decoded = true;
    image.pixels = {kTexels, kTexels, 1, ComponentType::F32, {}};
    image.pixels.bytes.resize(sizeof(float) * kTexels * kTexels);
    for (int y = 0; y < kTexels; ++y)
        for (int x = 0; x < kTexels; ++x) {
            const auto h = static_cast<float>(sineAt({(x + 0.5L) / kTexels, (y + 0.5L) / kTexels}).value);
            std::memcpy(&image.pixels.bytes[sizeof h * static_cast<size_t>(y * kTexels + x)], &h, sizeof h);
        }
    return image;
}

Scene sceneWith(const Body& body) {
    Scene scene;
    scene.materials.emplace_back();
    static const Image sine = sineImage();
    scene.images.push_back(sine);
    HeightMap map;
    map.texture = texture(0);
    map.scale = static_cast<float>(body.heightScale);
    scene.materials[0].haptic.height = {map, HapticSource::Touchstone};
    place(scene, body.mesh, 0);
    return scene;
}

HapticSettings settingsFor(TextureMode mode) {
    HapticSettings s;
    s.texture = mode;
    s.friction = FrictionMode::Off;
    s.stiffness = kStiffness;
    s.textureTiltLimit = 0.5 * glm::pi<double>();
    return s;
}

struct Facet {
    Vec p[3], normal[3];
    Uv uv[3];
    [[nodiscard]] Vec area() const { return glm::cross(p[1] - p[0], p[2] - p[0]); }
    /// Solves grad . e1 = f1 - f0, grad . e2 = f2 - f0, grad . area = 0.
    [[nodiscard]] Vec gradient(int axis) const {
        const glm::tmat3x3<Real> rows =
            glm::transpose(glm::tmat3x3<Real>(p[1] - p[0], p[2] - p[0], glm::normalize(area())));
        return glm::inverse(rows) * Vec(uv[1][axis] - uv[0][axis], uv[2][axis] - uv[0][axis], 0.0L);
    }
};
Facet facetOf(const Mesh& mesh, size_t t) {
    Facet f;
    for (size_t k = 0; k < 3; ++k) {
        const uint32_t v = mesh.indices[3 * t + k];
        f.p[k] = Vec(mesh.positions[v]);
        f.normal[k] = Vec(mesh.normals[v]);
        f.uv[k] = Uv(mesh.uv0[v]);
    }
    return f;
}

/// Mean gradient of u or v, by area, over the facets round a place: a seam changes u, not its gradient.
Vec gradientAround(const Mesh& mesh, const Vec& place, int axis, Real reach) {
    Vec sum(0.0L);
    Real area = 0.0L;
    for (size_t t = 0; t < mesh.triangleCount(); ++t) {
        bool there = false;
        for (size_t k = 0; k < 3; ++k)
            there |= glm::length(Vec(mesh.positions[mesh.indices[3 * t + k]]) - place) < reach;
        if (!there)
            continue;
        const Facet f = facetOf(mesh, t);
        const Real a = glm::length(f.area());
        if (a > reach * reach) {
            sum += a * f.gradient(axis);
            area += a;
        }
    }
    return sum / area;
}

/// The law on the mesh at the tick's triangle and proxy, everything else from the mesh itself.
Vec onTheMesh(const Body& body, TextureMode mode, const HapticOutput& out) {
    const Facet f = facetOf(body.mesh, static_cast<size_t>(out.triangle));
    const Vec proxy(out.proxy), way = proxy - Vec(out.hip), area = f.area();
    Real weight[3];
    for (size_t k = 0; k < 3; ++k)
        weight[k] =
            glm::dot(glm::cross(f.p[(k + 2) % 3] - f.p[(k + 1) % 3], proxy - f.p[(k + 1) % 3]), area) /
            glm::dot(area, area);
    Uv uv(0.0L);
    Vec n(0.0L), gradU(0.0L), gradV(0.0L);
    const Real reach = 1e-6L * glm::length(f.p[1] - f.p[0]) + 1e-9L * body.heightScale;
    for (size_t k = 0; k < 3; ++k) {
        uv += weight[k] * f.uv[k];
        n += weight[k] * f.normal[k];
        gradU += weight[k] * gradientAround(body.mesh, f.p[k], 0, reach);
        gradV += weight[k] * gradientAround(body.mesh, f.p[k], 1, reach);
    }
    const Sine s = sineAt(uv);
    return lawForce(mode, glm::normalize(n), glm::length(way), body.heightScale * s.value,
                    0.5L * body.heightScale, body.heightScale * (s.du * gradU + s.dv * gradV));
}

/// The law on the smooth shape.
Vec onTheShape(const Body& body, TextureMode mode, const glm::dvec3& hip) {
    const Uv uv = body.below(Vec(hip));
    const Vec pu = partial(body, uv, 0), pv = partial(body, uv, 1), way = body.point(uv) - Vec(hip);
    const Vec n = glm::normalize(way);
    const Real uu = glm::dot(pu, pu), mixed = glm::dot(pu, pv), vv = glm::dot(pv, pv),
               det = uu * vv - mixed * mixed;
    const Sine s = sineAt(uv);
    const Vec slope =
        body.heightScale / det * ((vv * s.du - mixed * s.dv) * pu + (uu * s.dv - mixed * s.du) * pv);
    return lawForce(mode, n, glm::length(way), body.heightScale * s.value, 0.5L * body.heightScale, slope);
}

struct Errors {
    double worstOnMesh = 0.0, meanOnShape = 0.0; ///< parts of the force; of k d where that may be nothing
    double meanTurn = 0.0;                       ///< rad, of m from the smooth shape's
    int deep = 0, shallow = 0;                   ///< samples with d >= H and below it
};

Errors press(const Body& body, TouchBench& bench) {
    constexpr int kSamples = 24;
    const TextureMode mode = bench.settings.texture;
    Errors errors;
    for (int i = 0; i < kSamples; ++i) {
        const Real golden = 0.6180339887498949L, a = (i + 0.5L) / kSamples, b = std::fmod(i * golden, 1.0L);
        const Uv uv = body.from + (body.to - body.from) * Uv(a, b);
        const Vec p = body.point(uv),
                  n = glm::normalize(glm::cross(partial(body, uv, 1), partial(body, uv, 0)));
        const Real depth = body.heightScale * (i % 2 == 0 ? 1.5L : 0.25L);
        const glm::dvec3 hip(p - depth * n), start(p + body.heightScale * n);
        bench.state[0].forgetTouch();
        bench.step(start);
        for (int t = 1; t <= 40; ++t)
            bench.step(start + (hip - start) * (t / 40.0));
        const HapticOutput& out = bench.step(hip);
        EXPECT_GT(out.contacts, 0u) << body.name;
        EXPECT_FALSE(has(out.flags, TickFlag::ShadingNotConverged)) << body.name;
        const Vec force(out.force), onMesh = onTheMesh(body, mode, out),
                                    onShape = onTheShape(body, mode, hip);
        const auto share = [&](const Vec& expected) {
            const Real whole = mode == TextureMode::BlinnMagnitude ? static_cast<Real>(kStiffness) * depth
                                                                   : glm::length(expected);
            return static_cast<double>(glm::length(force - expected) / whole);
        };
        errors.worstOnMesh = std::max(errors.worstOnMesh, share(onMesh));
        errors.meanOnShape += share(onShape) / kSamples;
        // Blinn's force is along m; what is left of the error then has nothing to do with the depth.
        const Vec m = glm::normalize(onTheShape(body, TextureMode::Blinn, hip));
        errors.meanTurn += static_cast<double>(glm::length(Vec(out.normal) - m)) / kSamples;
        (out.penetration >= out.height ? errors.deep : errors.shallow) += 1;
    }
    return errors;
}

class TextureLaw : public ::testing::TestWithParam<TextureMode> {};

TEST_P(TextureLaw, OnAMeshAndOnTheShapeThatItStandsFor) {
    for (const double size : {0.1, 1.0, 10.0})
        for (const auto make : {planeBody, sphereBody, torusBody}) {
            Errors last;
            for (const int cells : {24, 48, 96}) {
                const Body body = make(cells, size);
                SCOPED_TRACE(std::string(body.name) + ", " + std::to_string(cells) + " cells, size " +
                             std::to_string(size));
                TouchBench bench(sceneWith(body), settingsFor(GetParam()));
                const Errors errors = press(body, bench);
                EXPECT_LT(errors.worstOnMesh, 0.01);
                EXPECT_GT(errors.deep, 0);
                EXPECT_GT(errors.shallow, 0);
                if (body.name == std::string("plane")) {
                    EXPECT_LT(errors.meanOnShape, 0.002);
                } else if (last.deep > 0) {
                    EXPECT_NEAR(last.meanOnShape / errors.meanOnShape, 4.0, 0.8);
                    EXPECT_NEAR(last.meanTurn / errors.meanTurn, 4.0, 0.8);
                }
                if (std::getenv("TEXTURE_FIGURES") != nullptr)
                    std::printf("%s, %d cells: on the mesh %.1e, on the shape %.1e, m %.1e rad\n", body.name,
                                cells, errors.worstOnMesh, errors.meanOnShape, errors.meanTurn);
                last = errors;
            }
        }
}

TEST(TextureLawByRung, EveryFilterAndGradientComesToTheSameLaw) {
    // 340 texels a wave. The nearest one's height is off by half a texel, and its slope, as a bilinear
    // patch's own, by half a texel's turn.
    for (const auto make : {planeBody, torusBody}) {
        const Body body = make(48, 1.0);
        TouchBench bench(sceneWith(body), settingsFor(TextureMode::Law));
        for (const TextureFilter filter :
             {TextureFilter::Nearest, TextureFilter::Bilinear, TextureFilter::Bicubic, TextureFilter::Mip})
            for (const TextureGradient gradient :
                 {TextureGradient::Central, TextureGradient::Precomputed, TextureGradient::Analytic}) {
                const bool patch = filter != TextureFilter::Bicubic && gradient == TextureGradient::Analytic;
                if (filter == TextureFilter::Nearest && patch)
                    continue; // has no slope
                bench.settings.textureFilter = filter;
                bench.settings.textureGradient = gradient;
                const Errors errors = press(body, bench);
                const std::string name = settingValue(bench.settings, "textureFilter") + ", " +
                                         settingValue(bench.settings, "textureGradient");
                EXPECT_LT(errors.worstOnMesh, filter == TextureFilter::Nearest || patch ? 2e-3 : 2e-5)
                    << body.name << ", " << name;
                if (std::getenv("TEXTURE_FIGURES") != nullptr)
                    std::printf("%s, %s: on the mesh %.1e\n", body.name, name.c_str(), errors.worstOnMesh);
            }
    }
}

std::string nameOf(const ::testing::TestParamInfo<TextureMode>& configuration) {
    return settingValue(settingsFor(configuration.param), "texture");
}
INSTANTIATE_TEST_SUITE_P(Configurations, TextureLaw,
                         ::testing::Values(TextureMode::Law, TextureMode::Blinn, TextureMode::Minsky,
                                           TextureMode::BlinnMagnitude),
                         nameOf);

} // namespace
} // namespace touchstone::test::texture_law_test

// The configurations of textureFilter and textureGradient: against kernels written here as their papers have
// them, against a bump height in closed form, and in the hand.

#include "haptics/texture/haptic_map.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/test_shapes.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>

namespace touchstone::test::texture_filter_test {
namespace {

using Real = long double;
using Filter = TextureFilter;
using Gradient = TextureGradient;
constexpr Real kTau = 6.283185307179586476925L;
constexpr std::array kFilters{Filter::Nearest, Filter::Bilinear, Filter::Bicubic, Filter::Mip};
constexpr std::array kGradients{Gradient::Central, Gradient::Precomputed, Gradient::Analytic};

std::string nameOf(Filter filter, Gradient gradient) {
    HapticSettings s;
    s.textureFilter = filter;
    s.textureGradient = gradient;
    return settingValue(s, "textureFilter") + ", " + settingValue(s, "textureGradient");
}

using Height = std::function<double(double u, double v)>;
PixelData pixelsOf(int width, int height, const Height& at) {
    PixelData pixels{width, height, 1, ComponentType::F32, {}};
    pixels.bytes.resize(sizeof(float) * static_cast<size_t>(width) * static_cast<size_t>(height));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto h = static_cast<float>(at((x + 0.5) / width, (y + 0.5) / height));
            std::memcpy(&pixels.bytes[sizeof h * static_cast<size_t>(y * width + x)], &h, sizeof h);
        }
    return pixels;
}
TextureRef wrapping(Wrap s, Wrap t) {
    TextureRef reference;
    reference.wrapS = s;
    reference.wrapT = t;
    return reference;
}

/// What the interface of a map is to give: height, d/du, d/dv.
struct Read {
    double value, du, dv;
    Read(Real v, Real u, Real w)
        : value(static_cast<double>(v)), du(static_cast<double>(u)), dv(static_cast<double>(w)) {}
};
Read read(const HapticMap& map, Filter filter, Gradient gradient, const glm::dvec2& uv,
          const HapticMap::Slopes* kept = nullptr) {
    const HapticMap::Slope s = map.slopeBy(filter, gradient, uv, 0.0, kept);
    return {s.value, s.gradient.x, s.gradient.y};
}

// The kernels, of the distance from a texel's centre in texels.
Real box(Real t) {
    return t >= -0.5L && t < 0.5L ? 1.0L : 0.0L;
}
Real tent(Real t) {
    return std::max(1.0L - std::abs(t), 0.0L);
}
/// Keys, "Cubic convolution interpolation for digital image processing" (1981), a = -1/2: Catmull and Rom.
Real keys(Real t) {
    const Real s = std::abs(t);
    return s < 1.0L   ? (1.5L * s - 2.5L) * s * s + 1.0L
           : s < 2.0L ? ((-0.5L * s + 2.5L) * s - 4.0L) * s + 2.0L
                      : 0.0L;
}
Real keysSlope(Real t) {
    const Real s = std::abs(t), side = t < 0.0L ? -1.0L : 1.0L;
    return side * (s < 1.0L ? (4.5L * s - 5.0L) * s : s < 2.0L ? (-1.5L * s + 5.0L) * s - 4.0L : 0.0L);
}
using Kernel = Real (*)(Real);
Kernel kernelOf(Filter filter) {
    return filter == Filter::Nearest ? box : filter == Filter::Bicubic ? keys : tent;
}
Real zero(Real) {
    return 0.0L;
}
Real tentSlope(Real t) {
    return t > -1.0L && t <= 0.0L ? 1.0L : t > 0.0L && t <= 1.0L ? -1.0L : 0.0L;
}
Kernel slopeKernelOf(Filter filter) {
    return filter == Filter::Nearest ? zero : filter == Filter::Bicubic ? keysSlope : tentSlope;
}

/// The definition: sums of kernels over an endless grid of texels.
Real wrapped(Real t, Wrap wrap) {
    if (wrap == Wrap::ClampToEdge)
        return std::clamp(t, 0.0L, 1.0L);
    if (wrap == Wrap::Repeat)
        return t - std::floor(t);
    const Real two = t - 2.0L * std::floor(0.5L * t);
    return two > 1.0L ? 2.0L - two : two;
}
struct Endless {
    int width, height;
    Wrap s, t;
    Height at;
    [[nodiscard]] Real texel(int x, int y) const {
        const Real u = wrapped((x + 0.5L) / width, s), v = wrapped((y + 0.5L) / height, t);
        const int column = std::min(static_cast<int>(std::floor(u * width)), width - 1),
                  row = std::min(static_cast<int>(std::floor(v * height)), height - 1);
        return static_cast<float>(at((column + 0.5) / width, (row + 0.5) / height));
    }
    template <class Texel>
    [[nodiscard]] static Real sum(Real x, Real y, Kernel across, Kernel down, const Texel& texel) {
        Real total = 0.0L;
        for (int j = static_cast<int>(std::floor(y)) - 4; j < y + 4.0L; ++j)
            for (int i = static_cast<int>(std::floor(x)) - 4; i < x + 4.0L; ++i)
                total += across(x - i - 0.5L) * down(y - j - 0.5L) * texel(i, j);
        return total;
    }
    [[nodiscard]] Read expected(Filter filter, Gradient gradient, const glm::dvec2& uv) const {
        const Real x = static_cast<Real>(uv.x) * width, y = static_cast<Real>(uv.y) * height;
        const Kernel kernel = kernelOf(filter), slope = slopeKernelOf(filter);
        const auto value = [&](Real a, Real b) {
            return sum(a, b, kernel, kernel, [&](int i, int j) { return texel(i, j); });
        };
        const auto derivative = [&](Kernel across, Kernel down) {
            return sum(x, y, across, down, [&](int i, int j) { return texel(i, j); });
        };
        const auto kept = [&](int right, int below) {
            return sum(x, y, kernel, kernel, [&](int i, int j) {
                return 0.5L * (texel(i + right, j + below) - texel(i - right, j - below));
            });
        };
        Real du = 0.0L, dv = 0.0L; // per texel
        switch (gradient) {
        case Gradient::Central:
            du = value(x + 0.5L, y) - value(x - 0.5L, y);
            dv = value(x, y + 0.5L) - value(x, y - 0.5L);
            break;
        case Gradient::Precomputed:
            du = kept(1, 0);
            dv = kept(0, 1);
            break;
        case Gradient::Analytic:
            du = derivative(slope, kernel);
            dv = derivative(kernel, slope);
            break;
        }
        return {value(x, y), width * du, height * dv};
    }
};

double rough(double u, double v) {
    return 0.5 + 0.5 * std::sin(40.0 * u + 17.0 * v * v + 3.0 * u * v);
}

TEST(TextureFilter, EveryRungIsItsKernelAtAnySizeAndWrap) {
    for (const glm::ivec2& size :
         {glm::ivec2(7, 5), glm::ivec2(8, 4), glm::ivec2(1, 6), glm::ivec2(6, 1), glm::ivec2(2, 3)})
        for (const Wrap s : {Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge})
            for (const Wrap t : {Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge}) {
                const HapticMap map(pixelsOf(size.x, size.y, rough), wrapping(s, t), 1);
                const HapticMap::Slopes kept = map.texelSlopes();
                const Endless endless{size.x, size.y, s, t, rough};
                for (const Filter filter : kFilters)
                    for (const Gradient gradient : kGradients)
                        for (int i = 0; i < 25; ++i) {
                            const glm::dvec2 uv(-2.317 + 0.1817 * i, 1.913 - 0.1637 * i);
                            const Read now = read(map, filter, gradient, uv, &kept);
                            const Read wanted = endless.expected(filter, gradient, uv);
                            ASSERT_NEAR(now.value, wanted.value, 1e-12) << nameOf(filter, gradient);
                            const double rounding = gradient == Gradient::Precomputed ? 1e-6 : 1e-12;
                            ASSERT_NEAR(now.du, wanted.du, rounding * size.x) << nameOf(filter, gradient);
                            ASSERT_NEAR(now.dv, wanted.dv, rounding * size.y) << nameOf(filter, gradient);
                            // A map of one channel is read with the same weights.
                            if (filter != Filter::Mip) {
                                HapticMap::Patch patch;
                                map.patch(uv, filter, patch);
                                ASSERT_NEAR(map.scalar(patch), wanted.value, 1e-12);
                            }
                        }
            }
}

TEST(TextureFilter, KeepingTheSlopesChangesNoBit) {
    const HapticMap map(pixelsOf(13, 9, rough), wrapping(Wrap::MirroredRepeat, Wrap::ClampToEdge), 1);
    const HapticMap::Slopes kept = map.texelSlopes();
    for (const Filter filter : kFilters)
        for (int i = 0; i < 200; ++i) {
            const glm::dvec2 uv(-2.3 + 0.0317 * i, 1.9 - 0.0237 * i);
            const double level = 0.017 * i;
            const HapticMap::Slope a = map.slopeBy(filter, Gradient::Precomputed, uv, level, &kept),
                                   b = map.slopeBy(filter, Gradient::Precomputed, uv, level, nullptr);
            ASSERT_EQ(a.value, b.value);
            ASSERT_EQ(a.gradient, b.gradient);
        }
}

TEST(TextureFilter, OneTexelIsFlatAndPlacesWithoutAFractionDoNoHarm) {
    const HapticMap map(pixelsOf(1, 1, [](double, double) { return 0.375; }), {}, 1);
    for (const Filter filter : kFilters)
        for (const Gradient gradient : kGradients)
            for (const double place : {0.0, -7.3, 0.5, 1e30, -1e30, static_cast<double>(NAN)}) {
                const Read now = read(map, filter, gradient, {place, -place});
                EXPECT_NEAR(now.value, 0.375, 1e-15) << nameOf(filter, gradient) << " at " << place;
                EXPECT_NEAR(now.du, 0.0, 1e-15) << nameOf(filter, gradient) << " at " << place;
                EXPECT_NEAR(now.dv, 0.0, 1e-15) << nameOf(filter, gradient) << " at " << place;
            }
}

TEST(TextureFilter, AStepIsACliffARampOrARampThatSwings) {
    // Four texels black, four white. In texels, 3.5 and 4.5 are the centres to either side.
    const HapticMap map(pixelsOf(8, 1, [](double u, double) { return u < 0.5 ? 0.0 : 1.0; }),
                        wrapping(Wrap::ClampToEdge, Wrap::ClampToEdge), 1);
    const auto at = [&](Filter filter, double texel) {
        return read(map, filter, Gradient::Analytic, {texel / 8.0, 0.5});
    };
    EXPECT_EQ(at(Filter::Nearest, std::nextafter(4.0, 0.0)).value, 0.0);
    EXPECT_EQ(at(Filter::Nearest, 4.0).value, 1.0);
    EXPECT_NEAR(at(Filter::Bilinear, 3.75).value, 0.25, 1e-15);
    EXPECT_EQ(at(Filter::Bilinear, 3.75).du, 8.0);
    EXPECT_EQ(at(Filter::Bilinear, 3.25).du, 0.0);
    double low = 0.0, high = 0.0;
    for (double texel = 0.0; texel < 8.0; texel += 1e-3) {
        low = std::min(low, at(Filter::Bicubic, texel).value);
        high = std::max(high, at(Filter::Bicubic, texel).value);
    }
    EXPECT_NEAR(low, -2.0 / 27.0, 1e-6);
    EXPECT_NEAR(high, 1.0 + 2.0 / 27.0, 1e-6);
}

/// One wave of a bump height that repeats.
Read bump(const glm::dvec2& uv) {
    const Real a = kTau * uv.x + 0.3L, b = kTau * uv.y - 0.8L, c = kTau * (uv.x + uv.y);
    return {0.5L + 0.2L * std::sin(a) * std::cos(b) + 0.1L * std::sin(c),
            kTau * (0.2L * std::cos(a) * std::cos(b) + 0.1L * std::cos(c)),
            kTau * (-0.2L * std::sin(a) * std::sin(b) + 0.1L * std::cos(c))};
}
/// Worst over the texture; the slope as a share of the bump height's steepest.
struct WorstError {
    double value = 0.0, slope = 0.0;
};
WorstError errorOn(int texels, Filter filter, Gradient gradient) {
    const HapticMap map(pixelsOf(texels, texels,
                                 [](double u, double v) {
                                     return bump({u, v}).value;
                                 }),
                        {}, 1);
    WorstError worst;
    for (int i = 0; i < 41; ++i)
        for (int j = 0; j < 43; ++j) {
            const glm::dvec2 uv((i + 0.31) / 41.0, (j + 0.17) / 43.0);
            const Read now = read(map, filter, gradient, uv), wanted = bump(uv);
            worst.value = std::max(worst.value, std::abs(now.value - wanted.value));
            worst.slope = std::max(worst.slope, std::hypot(now.du - wanted.du, now.dv - wanted.dv));
        }
    worst.slope /= static_cast<double>(0.3L * kTau);
    return worst;
}

TEST(TextureFilter, ConvergesInTheOrderOfItsRung) {
    struct TimedConfiguration {
        Filter filter;
        Gradient gradient;
        double value, slope; ///< orders
    };
    for (const TimedConfiguration& configuration :
         {TimedConfiguration{Filter::Nearest, Gradient::Central, 1, 1},
          TimedConfiguration{Filter::Nearest, Gradient::Precomputed, 1, 1},
          TimedConfiguration{Filter::Bilinear, Gradient::Central, 2, 2},
          TimedConfiguration{Filter::Bilinear, Gradient::Precomputed, 2, 2},
          TimedConfiguration{Filter::Bilinear, Gradient::Analytic, 2, 1},
          TimedConfiguration{Filter::Bicubic, Gradient::Central, 3, 2},
          TimedConfiguration{Filter::Bicubic, Gradient::Precomputed, 3, 2},
          TimedConfiguration{Filter::Bicubic, Gradient::Analytic, 3, 2},
          TimedConfiguration{Filter::Mip, Gradient::Central, 2, 2},
          TimedConfiguration{Filter::Mip, Gradient::Precomputed, 2, 2},
          TimedConfiguration{Filter::Mip, Gradient::Analytic, 2, 1}}) {
        const WorstError coarse = errorOn(16, configuration.filter, configuration.gradient),
                         fine = errorOn(64, configuration.filter, configuration.gradient);
        const double value = 0.5 * std::log2(coarse.value / fine.value),
                     slope = 0.5 * std::log2(coarse.slope / fine.slope);
        EXPECT_NEAR(value, configuration.value, 0.25) << nameOf(configuration.filter, configuration.gradient);
        EXPECT_NEAR(slope, configuration.slope, 0.25) << nameOf(configuration.filter, configuration.gradient);
        if (std::getenv("TEXTURE_FIGURES") != nullptr)
            std::printf("%s: 16 texels a wave %.1e and slope %.1e, 64 texels %.1e and %.1e\n",
                        nameOf(configuration.filter, configuration.gradient).c_str(), coarse.value,
                        coarse.slope, fine.value, fine.slope);
    }
    EXPECT_NEAR(errorOn(64, Filter::Nearest, Gradient::Analytic).slope, 1.0, 0.05)
        << "a staircase has no slope";
}

// In the hand.

Image imageOf(int width, int height, const Height& at) {
    Image image;
    image.decoded = true;
    image.pixels = pixelsOf(width, height, at);
    return image;
}
HapticSettings settingsFor(Filter filter, Gradient gradient) {
    HapticSettings s;
    s.texture = TextureMode::Minsky;
    s.friction = FrictionMode::Off;
    s.stiffness = 1000.0;
    s.textureTiltLimit = 0.5 * glm::pi<double>();
    s.textureFilter = filter;
    s.textureGradient = gradient;
    return s;
}
/// A plane of 0.1 m with `uvOf` its places and this image as its heights.
Scene planeOf(Image image, double scale, TextureRef reference = {},
              const std::function<glm::vec2(const glm::vec3&)>& uvOf = {}) {
    Scene scene;
    scene.materials.emplace_back();
    scene.images.push_back(std::move(image));
    HeightMap map;
    map.texture = reference;
    map.texture.image = 0;
    map.scale = static_cast<float>(scale);
    scene.materials[0].haptic.height = {map, HapticSource::Touchstone};
    Mesh mesh = quadMesh(0.05, 2);
    for (size_t v = 0; uvOf && v < mesh.positions.size(); ++v)
        mesh.uv0[v] = uvOf(mesh.positions[v]);
    place(scene, mesh, 0);
    return scene;
}

TEST(TextureFilter, SlopesFollowTransformsAndMirrors) {
    const auto ramp = [](double u, double v) { return 0.7 * u + 0.2 * v; };
    const auto tiled = [](const glm::vec3& p) { return glm::vec2(0.5f) + 10.0f * glm::vec2(p.x, -p.y); };
    TextureRef turned = wrapping(Wrap::ClampToEdge, Wrap::ClampToEdge);
    turned.rotation = 0.4f;
    turned.scale = {0.6f, 0.8f};
    turned.offset = {0.1f, 0.3f};
    TextureRef mirrored = wrapping(Wrap::MirroredRepeat, Wrap::MirroredRepeat);
    mirrored.offset = {1.0f, -1.0f};
    const double c = std::cos(0.4), s = std::sin(0.4);
    // d(u, v)'/d(x, y) by hand: u' = 0.1 + 0.6 c u + 0.8 s v, v' = 0.3 - 0.6 s u + 0.8 c v; mirrored: -u, -v.
    const glm::dvec2 slopes[] = {
        {10.0 * (0.7 * 0.6 * c - 0.2 * 0.6 * s), -10.0 * (0.7 * 0.8 * s + 0.2 * 0.8 * c)}, {-7.0, 2.0}};
    for (const Filter filter : kFilters)
        for (const Gradient gradient : kGradients)
            for (const int which : {0, 1}) {
                if (filter == Filter::Nearest && gradient == Gradient::Analytic)
                    continue;
                constexpr double kScale = 0.01;
                TouchBench bench(
                    planeOf(imageOf(64, 64, ramp), kScale, which == 0 ? turned : mirrored, tiled),
                    settingsFor(filter, gradient));
                bench.step({0.011, -0.007, 0.005});
                bench.moveTo({0.011, -0.007, -0.001}, 0.05);
                const glm::dvec3 f = bench.output.force;
                const glm::dvec2 wanted = -kScale * f.z * slopes[which];
                EXPECT_NEAR(f.x, wanted.x, 1e-5) << nameOf(filter, gradient) << which;
                EXPECT_NEAR(f.y, wanted.y, 1e-5) << nameOf(filter, gradient) << which;
                EXPECT_GT(f.z, 0.9);
            }
}

TEST(TextureFilter, FactorAndNormalMapsAreReadByItToo) {
    // Stiffness a half on the left and whole on the right, at 3/8 of the way between the texels' centres.
    const double share = 0.375, x = (share - 0.5) * 0.1 / 8.0;
    const auto cubic = [](double w) { return 0.5 * w * (1.0 + w * (4.0 - 3.0 * w) + w * (w - 1.0)); };
    for (const auto& [filter, white] : {std::pair{Filter::Nearest, 0.0},
                                        {Filter::Bilinear, share},
                                        {Filter::Bicubic, cubic(share)},
                                        {Filter::Mip, share}}) {
        Scene scene;
        scene.materials.emplace_back();
        scene.images.push_back(imageOf(8, 1, [](double u, double) { return u < 0.5 ? 0.0 : 1.0; }));
        scene.images.push_back(image("normals", 8, 1, 3, [](double u, double) {
            return glm::vec4(u < 0.5 ? 0.5f : 0.6f, 0.5f, 1.0f, 1.0f);
        }));
        FactorMap factor;
        factor.texture = texture(0);
        factor.min = 0.5f;
        factor.max = 1.0f;
        scene.materials[0].haptic.stiffnessMap = {factor, HapticSource::Touchstone};
        scene.materials[0].normalTexture = texture(1);
        place(scene, quadMesh(0.05, 2), 0);
        HapticSettings s = settingsFor(filter, Gradient::Central);
        s.texture = TextureMode::Law;
        TouchBench bench(scene, s);
        bench.step({x, 0.0, 0.002});
        bench.moveTo({x, 0.0, -0.001}, 0.05);
        bench.step({x, 0.0, -0.001});
        const double stiffness = 1000.0 * (0.5 + 0.5 * white);
        EXPECT_NEAR(glm::length(bench.output.force), stiffness * bench.output.penetration, 1e-6)
            << nameOf(filter, Gradient::Central);
        // The image's bytes: 128 and 153 of 255 are x = 1/255 and 51/255, z = 1.
        const glm::dvec3 m(((1.0 - white) * 1.0 + white * 51.0) / 255.0, 1.0 / 255.0, 1.0);
        EXPECT_LT(glm::length(bench.output.normal - glm::normalize(m)), 1e-6)
            << nameOf(filter, Gradient::Central);
    }
}

TEST(TextureFilter, OnlyMipsKeepWhatTheServoCannotSampleFromBuzzing) {
    // Waves of 0.9 mm crossed at 1 m/s: 1111 Hz, of which a servo of 1 kHz makes 111 Hz.
    constexpr int kWaves = 111, kTexels = 16 * kWaves;
    constexpr double kScale = 1e-4;
    const double slope = 0.5 * kScale * static_cast<double>(kTau) * kWaves / 0.1;
    const auto buzz = [&](Filter filter, Gradient gradient, double speed) {
        TouchBench bench(planeOf(imageOf(kTexels, 1,
                                         [](double u, double) {
                                             return 0.5 +
                                                    0.5 * std::sin(static_cast<double>(kTau) * kWaves * u);
                                         }),
                                 kScale),
                         settingsFor(filter, gradient));
        bench.step({-0.045, 0.0, 0.001});
        bench.moveTo({-0.045, 0.0, -0.001}, 0.05);
        double squares = 0.0;
        int ticks = 0;
        bench.moveTo({0.045, 0.0, -0.001}, speed, [&](const HapticOutput& out) {
            if (out.hip.x > -0.01) { // the filtered speed has settled
                squares += out.force.x * out.force.x;
                ++ticks;
            }
        });
        return std::sqrt(squares / ticks); // N; 1 N of normal force
    };
    for (const Gradient gradient : kGradients) {
        for (const Filter filter : {Filter::Nearest, Filter::Bilinear, Filter::Bicubic}) {
            if (filter == Filter::Nearest && gradient == Gradient::Analytic)
                continue;
            EXPECT_NEAR(buzz(filter, gradient, 1.0) / (slope * std::sqrt(0.5)), 1.0, 0.1)
                << nameOf(filter, gradient) << ": all of it is felt, as another tone";
        }
        EXPECT_LT(buzz(Filter::Mip, gradient, 1.0), 0.01 * slope) << nameOf(Filter::Mip, gradient);
        EXPECT_NEAR(buzz(Filter::Mip, gradient, 0.02) / (slope * std::sqrt(0.5)), 1.0, 0.1)
            << "22 Hz are felt by mips, too";
    }
}

TEST(TextureFilter, ATickOfAnyRungAllocatesNothing) {
    for (const Filter filter : kFilters)
        for (const Gradient gradient : kGradients)
            for (const bool kept : {false, true}) {
                TouchBench bench(planeOf(imageOf(33, 17, rough), 1e-3), settingsFor(filter, gradient));
                if (kept)
                    bench.scene->buildSlopes();
                EXPECT_EQ(bench.scene->slopes() != nullptr, kept);
                bench.step({-0.04, 0.01, 0.001});
                const uint64_t before = allocationsOnThisThread();
                for (int i = 0; i < 100; ++i)
                    bench.step({-0.04 + 7e-4 * i, 0.01, -0.001});
                EXPECT_EQ(allocationsOnThisThread() - before, 0u) << nameOf(filter, gradient);
                EXPECT_GT(bench.output.contacts, 0u);
            }
}

TEST(TextureFilter, AStaircaseWithoutSlopesIsToldOf) {
    EXPECT_TRUE(settingWarnings(settingsFor(Filter::Nearest, Gradient::Central)).empty());
    const auto warnings = settingWarnings(settingsFor(Filter::Nearest, Gradient::Analytic));
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("textureFilter=nearest"), std::string::npos);
    for (const auto& [name, value] : {std::pair{"textureFilter", "trilinear"},
                                      {"textureFilter", ""},
                                      {"textureGradient", "sobel"},
                                      {"textureGradient", "1"}}) {
        HapticSettings s;
        const std::string problem = setSetting(s, name, value);
        EXPECT_NE(problem.find("allowed"), std::string::npos) << name << "=" << value;
        EXPECT_EQ(s, HapticSettings{});
    }
}

} // namespace
} // namespace touchstone::test::texture_filter_test

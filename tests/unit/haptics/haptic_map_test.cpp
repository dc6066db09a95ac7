// Maps as the hand reads them, against an evaluation written here from the glTF specification.

#include "haptics/texture/haptic_map.h"
#include "tests/support/test_shapes.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace touchstone::test::haptic_map_test {
namespace {

constexpr double kPi = 3.141592653589793;

/// Pixels of any type whose value at (x, y), channel c is as random as it is known.
double texel(int x, int y, int c) {
    return std::fmod(0.37 * x + 0.61 * y + 0.29 * c + 0.013 * x * y, 1.0);
}
PixelData pixelsOf(ComponentType type, int width, int height, int channels) {
    PixelData pixels{width, height, channels, type, {}};
    const auto append = [&](auto value) {
        const auto* bytes = reinterpret_cast<const std::byte*>(&value);
        pixels.bytes.insert(pixels.bytes.end(), bytes, bytes + sizeof value);
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c) {
                const double value = texel(x, y, c);
                if (type == ComponentType::U8)
                    append(static_cast<uint8_t>(std::lround(255.0 * value)));
                else if (type == ComponentType::U16)
                    append(static_cast<uint16_t>(std::lround(65535.0 * value)));
                else
                    append(static_cast<float>(value));
            }
    return pixels;
}

long double wrapped(long double t, Wrap wrap) {
    if (wrap == Wrap::ClampToEdge)
        return std::clamp(t, 0.0L, 1.0L);
    if (wrap == Wrap::Repeat)
        return t - std::floor(t);
    const long double two = t - 2.0L * std::floor(0.5L * t);
    return two > 1.0L ? 2.0L - two : two;
}

/// Bilinear between texel centres. Wrapping the place of each centre is wrapping its index.
long double expected(int width, int height, Wrap s, Wrap t, const glm::dvec2& uv, int channel = 0) {
    const long double x = static_cast<long double>(uv.x) * width - 0.5L,
                      y = static_cast<long double>(uv.y) * height - 0.5L;
    long double sum = 0.0L;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const long double cx = std::floor(x) + i, cy = std::floor(y) + j;
            const long double u = wrapped((cx + 0.5L) / width, s), v = wrapped((cy + 0.5L) / height, t);
            const int column = std::min(static_cast<int>(std::floor(u * width)), width - 1),
                      row = std::min(static_cast<int>(std::floor(v * height)), height - 1);
            sum += (1.0L - std::abs(x - cx)) * (1.0L - std::abs(y - cy)) *
                   static_cast<long double>(texel(column, row, channel));
        }
    return sum;
}

TEST(HapticMap, EveryTypeAndWrapModeIsBilinearBetweenTexelCentres) {
    for (const auto& [type, tolerance] : {std::pair{ComponentType::U8, 0.5 / 255.0 + 1e-6},
                                          {ComponentType::U16, 0.5 / 65535.0 + 1e-6},
                                          {ComponentType::F32, 1e-6}})
        for (const Wrap s : {Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge})
            for (const Wrap t : {Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge}) {
                TextureRef reference;
                reference.wrapS = s;
                reference.wrapT = t;
                const HapticMap map(pixelsOf(type, 7, 5, 3), reference, 3);
                for (int i = 0; i < 400; ++i) {
                    const glm::dvec2 uv(-2.3 + 0.01171 * i, 1.9 - 0.0137 * i);
                    const glm::dvec3 read = map.vector(map.transform(uv), 0.0);
                    for (int c = 0; c < 3; ++c)
                        ASSERT_NEAR(read[c], static_cast<double>(expected(7, 5, s, t, uv, c)), tolerance);
                }
            }
}

TEST(HapticMap, TheSlopeIsTheCentralDifferenceOfHalfATexel) {
    constexpr int kWidth = 7, kHeight = 5;
    constexpr double du = 0.5 / kWidth, dv = 0.5 / kHeight;
    for (const Wrap s : {Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge})
        for (const Wrap t : {Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge}) {
            TextureRef reference;
            reference.wrapS = s;
            reference.wrapT = t;
            const HapticMap map(pixelsOf(ComponentType::F32, kWidth, kHeight, 1), reference, 1);
            const auto at = [&](double u, double v) { return expected(kWidth, kHeight, s, t, {u, v}); };
            for (int i = 0; i < 400; ++i) {
                const glm::dvec2 uv(-2.3 + 0.01171 * i, 1.9 - 0.0137 * i);
                const HapticMap::Slope read = map.slope(uv, 0.0);
                ASSERT_NEAR(read.value, static_cast<double>(at(uv.x, uv.y)), 1e-6);
                ASSERT_NEAR(read.gradient.x,
                            static_cast<double>((at(uv.x + du, uv.y) - at(uv.x - du, uv.y)) / (2 * du)),
                            1e-5);
                ASSERT_NEAR(read.gradient.y,
                            static_cast<double>((at(uv.x, uv.y + dv) - at(uv.x, uv.y - dv)) / (2 * dv)),
                            1e-5);
            }
        }
}

TEST(HapticMap, TheTransformIsThatOfItsExtension) {
    // KHR_texture_transform: uv' = translation * rotation * scale * uv, with the matrices as it prints them
    // (column by column: rotation (c, -s), (s, c)).
    TextureRef reference;
    reference.offset = {0.3f, -0.7f};
    reference.rotation = 0.6f;
    reference.scale = {2.5f, -0.4f};
    const HapticMap map(pixelsOf(ComponentType::F32, 4, 4, 1), reference, 1);
    const long double c = std::cos(static_cast<long double>(0.6f)),
                      s = std::sin(static_cast<long double>(0.6f));
    for (const glm::dvec2& uv : {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0.2, -3.0)}) {
        const long double x = 2.5L * uv.x, y = static_cast<long double>(-0.4f) * uv.y;
        const glm::dvec2 at = map.transform(uv);
        EXPECT_NEAR(at.x, static_cast<double>(0.3f + c * x + s * y), 1e-12);
        EXPECT_NEAR(at.y, static_cast<double>(-0.7f - s * x + c * y), 1e-12);
        EXPECT_LT(glm::length(at - glm::dvec2(reference.transform(glm::vec2(uv)))), 1e-6) << "hand and eye";
    }
}

TEST(HapticMap, CoarserLevelsKeepTheMeanAndTheSlopeAtAnySize) {
    for (const glm::ivec2& size :
         {glm::ivec2(64, 64), glm::ivec2(61, 37), glm::ivec2(5, 1), glm::ivec2(3, 2)}) {
        TextureRef reference;
        reference.wrapS = reference.wrapT = Wrap::ClampToEdge;
        PixelData pixels{size.x, size.y, 1, ComponentType::F32, {}};
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const auto h = static_cast<float>(0.2 + 0.5 * (x + 0.5) / size.x + 0.3 * (y + 0.5) / size.y);
                const auto* bytes = reinterpret_cast<const std::byte*>(&h);
                pixels.bytes.insert(pixels.bytes.end(), bytes, bytes + sizeof h);
            }
        const HapticMap map(pixels, reference, 1);
        EXPECT_NEAR(map.scalar({0.5, 0.5}, 99.0), 0.2 + 0.25 + 0.15, 1e-5) << "the coarsest is the mean";
        for (double level = 0.0; level < 2.0; level += 0.25)
            if (size.y > 16) {
                EXPECT_NEAR(map.scalar({0.4, 0.6}, level), 0.2 + 0.2 + 0.18, 1e-5) << level;
                EXPECT_LT(glm::length(map.slope({0.4, 0.6}, level).gradient - glm::dvec2(0.5, 0.3)), 1e-3)
                    << level;
            }
        for (const double level : {1.0, 2.0}) {
            const glm::dvec2 below = map.slope({0.4, 0.6}, level - 1e-9).gradient,
                             at = map.slope({0.4, 0.6}, level).gradient;
            EXPECT_LT(glm::length(below - at), 1e-6) << "no step where a level gives way to the next";
        }
    }
}

/// A plane in x and y, 0.1 m a side, of one ramp in u; its coordinates are `uvOf` the place.
struct Pressed {
    glm::dvec3 force;
    double depth, height;
};
Pressed press(int set, const std::function<glm::vec2(const glm::vec3&)>& uvOf, TextureRef reference) {
    Scene scene;
    scene.materials.emplace_back();
    scene.images.push_back(
        image("ramp", 256, 256, 1, [](double u, double) { return glm::vec4(static_cast<float>(u)); }));
    HeightMap map;
    map.texture = reference;
    map.texture.image = 0;
    map.texture.texCoord = set;
    map.scale = 0.01f;
    scene.materials[0].haptic.height = {map, HapticSource::Touchstone};
    Mesh mesh = quadMesh(0.05, 6);
    mesh.uv1.assign(mesh.uv0.size(), glm::vec2(0.5f));
    for (size_t v = 0; v < mesh.positions.size(); ++v)
        (set == 1 ? mesh.uv1 : mesh.uv0)[v] = uvOf(mesh.positions[v]);
    if (set == 1)
        mesh.uv0.assign(mesh.uv0.size(), glm::vec2(0.5f));
    place(scene, mesh, 0);
    HapticSettings s;
    s.texture = TextureMode::Blinn;
    s.friction = FrictionMode::Off;
    s.stiffness = 1000.0;
    s.textureTiltLimit = 0.5 * kPi;
    TouchBench bench(scene, s);
    bench.step({0.011, -0.007, 0.005});
    bench.moveTo({0.011, -0.007, -0.001}, 0.05);
    return {bench.output.force, bench.output.penetration, bench.output.height};
}

TEST(HapticMap, TheSlopeOnTheSurfaceFollowsSetsTransformsAndMirrors) {
    const auto plain = [](const glm::vec3& p) { return glm::vec2(0.5f) + 10.0f * glm::vec2(p.x, -p.y); };
    const auto mirrored = [](const glm::vec3& p) { return glm::vec2(0.5f) + 10.0f * glm::vec2(-p.x, -p.y); };
    TextureRef turned; // u' = 0.5 + 0.8 (c (u - 0.5) ...) about the middle, by 90 degrees
    turned.rotation = static_cast<float>(0.5 * kPi);
    turned.scale = glm::vec2(0.8f);
    turned.offset = {0.1f, 0.9f};
    for (const int set : {0, 1}) {
        // dH/dx = 0.01 m * 10 / m * du'/du.
        const auto expect = [&](const Pressed& at, const glm::dvec2& slope, double u) {
            const glm::dvec3 m = glm::normalize(glm::dvec3(-slope, 1.0));
            EXPECT_LT(glm::length(at.force - 1000.0 * at.depth * m), 2e-3 * 1000.0 * at.depth)
                << "set " << set;
            EXPECT_NEAR(at.height, 0.01 * (u - 0.5 / 256.0), 5e-5) << "set " << set;
        };
        expect(press(set, plain, {}), {0.1, 0.0}, 0.61);
        expect(press(set, mirrored, {}), {-0.1, 0.0}, 0.39);
        // Rotation by 90 degrees: u' = 0.1 + 0.8 v, and v = 0.5 - 10 y.
        expect(press(set, plain, turned), {0.0, -0.08}, 0.1 + 0.8 * 0.57);
        TextureRef second; // beyond one texture, mirrored: the ramp goes down
        second.wrapS = Wrap::MirroredRepeat;
        second.offset = {1.0f, 0.0f};
        expect(press(set, plain, second), {-0.1, 0.0}, 0.39);
    }
}

TEST(HapticMap, AStrokeReadsTheLevelWhoseTexelIsTwoTicksLong) {
    // Stripes of one texel: whole at level 0, gone at level 1. Between them the tilt falls with the level,
    // log2 of two strokes over a texel.
    constexpr int kTexels = 256;
    const double texelSize = 0.1 / kTexels;
    for (const double speed : {0.15, 0.25, 0.3, 0.45}) {
        Scene scene;
        scene.materials.emplace_back();
        scene.images.push_back(image("stripes", 1, kTexels, 1, [](double, double v) {
            return glm::vec4(static_cast<float>(static_cast<int>(v * kTexels) % 2));
        }));
        HeightMap map;
        map.texture = texture(0);
        map.scale = 1e-4f;
        scene.materials[0].haptic.height = {map, HapticSource::Touchstone};
        place(scene, quadMesh(0.05, 1), 0);
        HapticSettings s;
        s.texture = TextureMode::Minsky;
        s.friction = FrictionMode::Off;
        s.stiffness = 1000.0;
        s.textureTiltLimit = 0.5 * kPi;
        TouchBench bench(scene, s);
        // Along the stripes, half way down one flank, where the slope is largest: scale over a texel.
        const double y = 0.05 - 64.0 * texelSize;
        bench.step({-0.045, y, 0.001});
        bench.moveTo({-0.045, y, -0.001}, 0.05);
        bench.moveTo({0.03, y, -0.001}, speed);
        const double moved = 0.075 / std::ceil(0.075 / (speed * bench.dt));
        const double level = std::clamp(std::log2(2.0 * moved / texelSize), 0.0, 1.0);
        const double slope = (1.0 - level) * 1e-4 / texelSize;
        EXPECT_NEAR(std::abs(bench.output.force.y) / bench.output.force.z, slope, 0.02 * 1e-4 / texelSize)
            << speed;
    }
}

TEST(HapticMap, OfThreeChannelsTheFirstIsTheScalarByEveryFilter) {
    const PixelData pixels = pixelsOf(ComponentType::U16, 13, 7, 3);
    const HapticMap three(pixels, texture(0), 3), one(pixels, texture(0), 1);
    for (int i = 0; i < 50; ++i) {
        const glm::dvec2 uv(0.037 * i, 1.3 - 0.051 * i);
        const double level = 0.06 * i;
        EXPECT_NEAR(three.scalar(uv, level), one.scalar(uv, level), 1e-12);
        EXPECT_EQ(three.slope(uv, level).value, one.slope(uv, level).value);
        EXPECT_EQ(three.slope(uv, level).gradient, one.slope(uv, level).gradient);
        EXPECT_NEAR(three.vector(uv, level).x, one.scalar(uv, level), 1e-12);
        EXPECT_NEAR(glm::distance(one.vector(uv, level), glm::dvec3(one.scalar(uv, level), 0.0, 0.0)), 0.0,
                    1e-12);
        for (const TextureFilter filter :
             {TextureFilter::Nearest, TextureFilter::Bilinear, TextureFilter::Bicubic}) {
            HapticMap::Patch patch;
            three.patch(uv, filter, patch);
            EXPECT_EQ(three.scalar(patch), one.scalar(patch));
            EXPECT_NEAR(three.vector(patch).x, one.scalar(patch), 1e-12);
            for (const TextureGradient gradient :
                 {TextureGradient::Central, TextureGradient::Precomputed, TextureGradient::Analytic})
                EXPECT_EQ(three.slopeBy(filter, gradient, uv, level, nullptr).gradient,
                          one.slopeBy(filter, gradient, uv, level, nullptr).gradient);
        }
    }
}

} // namespace
} // namespace touchstone::test::haptic_map_test

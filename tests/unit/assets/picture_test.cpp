#include "assets/lettering.h"
#include "assets/picture.h"
#include "assets/scenes.h"
#include "tests/unit/assets/glb_reader.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchstone::assets {
namespace {

struct Decoded {
    int width = 0, height = 0, channels = 0;
    std::vector<double> values; ///< 0..1

    [[nodiscard]] double at(int x, int y, int c) const {
        const int column = (x % width + width) % width, row = (y % height + height) % height;
        return values[static_cast<size_t>((row * width + column) * channels + c)];
    }
};

Decoded decoded(std::vector<std::byte> file) {
    OIIO::Filesystem::IOMemReader memory(file.data(), file.size());
    auto input = OIIO::ImageInput::open("map.png", nullptr, &memory);
    Decoded image;
    if (!input)
        return image;
    const OIIO::ImageSpec& spec = input->spec();
    image = {spec.width, spec.height, spec.nchannels, {}};
    const bool wide = spec.format == OIIO::TypeDesc::UINT16;
    std::vector<uint16_t> words(static_cast<size_t>(spec.width * spec.height * spec.nchannels));
    std::vector<uint8_t> bytes(words.size());
    EXPECT_TRUE(wide ? input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT16, words.data())
                     : input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, bytes.data()));
    for (size_t i = 0; i < words.size(); ++i)
        image.values.push_back(wide ? words[i] / 65535.0 : bytes[i] / 255.0);
    return image;
}

TEST(Pictures, SurvivePng) {
    Picture<uint16_t> wide{3, 2, 1, {0, 1, 256, 32768, 65534, 65535}};
    const Decoded back = decoded(png(wide));
    ASSERT_EQ(back.width, 3);
    ASSERT_EQ(back.height, 2);
    for (size_t i = 0; i < wide.values.size(); ++i)
        EXPECT_EQ(back.values[i], wide.values[i] / 65535.0);
    EXPECT_TRUE(png(wide) == png(wide));
}

/// The normal map must be the slope of the height map in metres: green against growing rows, both wrapping.
void expectNormalsAreSlopes(const Decoded& heights, const Decoded& normals, double tileWidth, double scale) {
    ASSERT_EQ(heights.width, normals.width);
    ASSERT_EQ(normals.channels, 3);
    const double perTexel = scale * heights.width / tileWidth;
    for (int y = 0; y < heights.height; ++y)
        for (int x = 0; x < heights.width; ++x) {
            const double right = 0.5 * perTexel * (heights.at(x + 1, y, 0) - heights.at(x - 1, y, 0));
            const double down = 0.5 * perTexel * (heights.at(x, y + 1, 0) - heights.at(x, y - 1, 0));
            const glm::dvec3 expected = glm::normalize(glm::dvec3(-right, down, 1.0));
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(2.0 * normals.at(x, y, c) - 1.0, expected[c], 0.006) << x << ' ' << y;
        }
}

TEST(Pictures, ANormalMapIsTheSlopeOfItsHeightMap) {
    // Not symmetric in any way, so that a swapped axis or sign shows.
    const HeightFunction bump = [](double u, double v) {
        const double turn = 2.0 * std::numbers::pi;
        return 0.5 + 0.2 * std::sin(turn * u) + 0.2 * std::cos(turn * (2.0 * v + u));
    };
    expectNormalsAreSlopes(decoded(png(heightMap(bump, 128))),
                           decoded(png(normalMap(bump, 128, 0.03, 0.002))), 0.03, 0.002);
}

TEST(Pictures, TheDoughnutsMapsAgreeAndTile) {
    const test::GlbReader file(doughnut().bytes);
    const auto& haptic = file.json()["materials"][0]["extensions"]["TOUCHSTONE_materials_haptic"];
    const Decoded normals = decoded(file.image(0)), heights = decoded(file.image(1));
    const double scale = haptic["heightTexture"]["scale"];
    expectNormalsAreSlopes(heights, normals, 2.0 * std::numbers::pi * 0.060 / 12.0, scale);
    // Where the tile meets itself the step is no larger than anywhere inside.
    double inside = 0.0, across = 0.0;
    for (int i = 0; i < heights.width; ++i)
        for (int j = 0; j < heights.width; ++j) {
            double& largest = j + 1 == heights.width ? across : inside;
            largest = std::max({largest, std::abs(heights.at(j + 1, i, 0) - heights.at(j, i, 0)),
                                std::abs(heights.at(i, j + 1, 0) - heights.at(i, j, 0))});
        }
    EXPECT_LE(across, inside * (1 + 1e-9));
    EXPECT_GT(*std::max_element(heights.values.begin(), heights.values.end()), 0.99);
    EXPECT_LT(*std::min_element(heights.values.begin(), heights.values.end()), 0.01);
}

TEST(Pictures, NoiseTilesAndStaysInRange) {
    for (double t = 0.0; t < 1.0; t += 0.013) {
        EXPECT_NEAR(tilingNoise(0.0, t, 8, 3), tilingNoise(1.0, t, 8, 3), 1e-12);
        EXPECT_NEAR(tilingNoise(t, -1.0, 8, 3), tilingNoise(t, 0.0, 8, 3), 1e-12);
        EXPECT_GE(tilingNoise(t, 0.4, 8, 3), 0.0);
        EXPECT_LE(tilingNoise(t, 0.4, 8, 3), 1.0);
    }
    EXPECT_NE(tilingNoise(0.3, 0.4, 8, 3), tilingNoise(0.3, 0.4, 8, 4));
}

TEST(Pictures, LettersReadFromLeftToRight) {
    // L, a dot being 0.8 / 47 wide: ink in the left column and along the bottom, none at the upper right.
    constexpr double kDot = 0.8 / 47.0;
    EXPECT_TRUE(inked("L", 0.5 - 2 * kDot, 0.5));
    EXPECT_TRUE(inked("L", 0.5 + 2 * kDot, 0.5 + 3 * kDot));
    EXPECT_FALSE(inked("L", 0.5 + 2 * kDot, 0.5 - 3 * kDot));
    EXPECT_FALSE(inked("L", 0.01, 0.5)) << "beside the text there is none";
    EXPECT_FALSE(inked("", 0.5, 0.5));
}

} // namespace
} // namespace touchstone::assets

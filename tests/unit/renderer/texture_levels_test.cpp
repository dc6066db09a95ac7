#include "renderer/texture_levels.h"

#include <glm/gtc/packing.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace touchstone {
namespace {

PixelData bytes(int width, int height, int channels, const std::vector<int>& values) {
    PixelData pixels;
    pixels.width = width;
    pixels.height = height;
    pixels.channels = channels;
    for (const int value : values)
        pixels.bytes.push_back(static_cast<std::byte>(value));
    return pixels;
}

int texel(const TextureLevels& texture, size_t level, size_t index, size_t channel) {
    return std::to_integer<int>(texture.bytes[texture.levels[level].offset + 4 * index + channel]);
}

double linear(double byte) {
    const double c = byte / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

TEST(TextureLevels, EachLevelIsHalfTheOneBeforeDownToOneTexel) {
    const TextureLevels texture =
        buildTextureLevels(bytes(7, 3, 1, std::vector<int>(21, 9)), TextureRole::Data, 4096);
    ASSERT_EQ(texture.levels.size(), 3u);
    EXPECT_EQ(texture.levels[1].width, 3);
    EXPECT_EQ(texture.levels[1].height, 1);
    EXPECT_EQ(texture.levels[2].width, 1);
    EXPECT_EQ(texture.bytes.size(), size_t{4 * (21 + 3 + 1)});
    EXPECT_EQ(texel(texture, 2, 0, 0), 9) << "a constant stays what it is";
}

TEST(TextureLevels, ChannelsSpreadAsGreyAndAlpha) {
    const auto rgba = [](const TextureLevels& t) {
        return std::vector<int>{texel(t, 0, 0, 0), texel(t, 0, 0, 1), texel(t, 0, 0, 2), texel(t, 0, 0, 3)};
    };
    const auto of = [&](int channels, const std::vector<int>& values) {
        return rgba(buildTextureLevels(bytes(1, 1, channels, values), TextureRole::Color, 16));
    };
    EXPECT_EQ(of(1, {10}), (std::vector<int>{10, 10, 10, 255}));
    EXPECT_EQ(of(2, {10, 20}), (std::vector<int>{10, 10, 10, 20}));
    EXPECT_EQ(of(3, {10, 20, 30}), (std::vector<int>{10, 20, 30, 255}));
    EXPECT_EQ(of(4, {10, 20, 30, 40}), (std::vector<int>{10, 20, 30, 40}));
}

TEST(TextureLevels, ColoursAreAveragedInLinearLightAndDataIsNot) {
    const PixelData pixels = bytes(2, 2, 1, {0, 255, 0, 255});
    const TextureLevels color = buildTextureLevels(pixels, TextureRole::Color, 16);
    EXPECT_EQ(color.format, TexelFormat::Srgb8);
    EXPECT_NEAR(linear(texel(color, 1, 0, 0)), 0.5, 0.005);
    const TextureLevels data = buildTextureLevels(pixels, TextureRole::Data, 16);
    EXPECT_EQ(data.format, TexelFormat::Unorm8);
    EXPECT_EQ(texel(data, 1, 0, 0), 128);
}

TEST(TextureLevels, EveryColourByteSurvivesAveragingWithItself) {
    for (int value = 0; value < 256; ++value) {
        const TextureLevels color =
            buildTextureLevels(bytes(2, 2, 1, std::vector<int>(4, value)), TextureRole::Color, 16);
        ASSERT_EQ(texel(color, 1, 0, 0), value);
    }
}

TEST(TextureLevels, WhatIsTransparentDoesNotBleed) {
    const TextureLevels color =
        buildTextureLevels(bytes(2, 1, 4, {200, 100, 50, 255, 0, 0, 0, 0}), TextureRole::Color, 16);
    EXPECT_EQ(texel(color, 1, 0, 0), 200);
    EXPECT_EQ(texel(color, 1, 0, 2), 50);
    EXPECT_EQ(texel(color, 1, 0, 3), 128);
}

TEST(TextureLevels, SixteenBitsAndFloatsBecomeHalves) {
    PixelData pixels;
    pixels.width = 2;
    pixels.height = 1;
    pixels.channels = 1;
    pixels.type = ComponentType::F32;
    const std::array<float, 2> values{0.25f, -3.5f};
    pixels.bytes.resize(sizeof values);
    std::memcpy(pixels.bytes.data(), values.data(), sizeof values);
    const TextureLevels texture = buildTextureLevels(pixels, TextureRole::Data, 16);
    ASSERT_EQ(texture.format, TexelFormat::Half16);
    const auto half = [&](size_t level, size_t index) {
        uint16_t bits = 0;
        std::memcpy(&bits, &texture.bytes[texture.levels[level].offset + 8 * index], 2);
        return glm::unpackHalf1x16(bits);
    };
    EXPECT_EQ(half(0, 0), 0.25f);
    EXPECT_EQ(half(0, 1), -3.5f);
    EXPECT_EQ(half(1, 0), -1.625f);

    pixels.type = ComponentType::U16;
    const std::array<uint16_t, 2> words{65535, 0};
    pixels.bytes.resize(sizeof words);
    std::memcpy(pixels.bytes.data(), words.data(), sizeof words);
    EXPECT_EQ(buildTextureLevels(pixels, TextureRole::Data, 16).format, TexelFormat::Half16);
    const TextureLevels color = buildTextureLevels(pixels, TextureRole::Color, 16);
    EXPECT_EQ(color.format, TexelFormat::Srgb8);
    EXPECT_EQ(texel(color, 0, 0, 0), 255);
    EXPECT_EQ(texel(color, 0, 1, 0), 0);
}

TEST(TextureLevels, TooLargeImagesStartAtALowerLevel) {
    const TextureLevels texture =
        buildTextureLevels(bytes(16, 4, 1, std::vector<int>(64, 77)), TextureRole::Data, 8);
    EXPECT_EQ(texture.levels[0].width, 8);
    EXPECT_EQ(texture.levels[0].height, 2);
    EXPECT_EQ(texel(texture, 0, 0, 0), 77);
    EXPECT_EQ(texture.levels[0].offset, 0u);
}

} // namespace
} // namespace touchstone

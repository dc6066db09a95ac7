// Files of panoramas, written by OpenImageIO itself.

#include "engine/core/error.h"
#include "renderer/environment.h"
#include "tests/support/gltf_maker.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace touchstone {
namespace {

class EnvironmentFile : public ::testing::Test {
  protected:
    std::filesystem::path write(const std::string& name, int width, int height, int channels,
                                const std::function<float(int x, int y, int c)>& value, int tile = 0) {
        const std::filesystem::path path = folder_.path() / name;
        std::vector<float> values;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                for (int c = 0; c < channels; ++c)
                    values.push_back(value(x, y, c));
        const auto output = OIIO::ImageOutput::create(path.string());
        OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::FLOAT);
        spec.tile_width = spec.tile_height = tile;
        EXPECT_TRUE(output && output->open(path.string(), spec) &&
                    output->write_image(OIIO::TypeDesc::FLOAT, values.data()) && output->close());
        return path;
    }

    static std::string problem(const std::filesystem::path& path) {
        try {
            (void)loadEnvironment(path);
        } catch (const Error& error) {
            EXPECT_EQ(error.file(), path.string());
            EXPECT_FALSE(error.remedy().empty());
            return error.problem();
        }
        return "";
    }

    test::TemporaryFolder folder_;
};

TEST_F(EnvironmentFile, BothFormatsAreReadAndLargeOnesReduced) {
    const auto ramp = [](int x, int, int c) { return c == 0 ? static_cast<float>(x) : 2.0f; };
    for (const auto& [name, tile] : {std::pair{"a.exr", 0}, {"tiled.exr", 64}, {"a.hdr", 0}}) {
        const Panorama read = readPanorama(write(name, 64, 32, 3, ramp, tile));
        ASSERT_EQ(read.width, 64) << name;
        ASSERT_EQ(read.height, 32) << name;
        EXPECT_NEAR(read.texels[64 * 5 + 40].x, 40.0f, 0.5f) << name;
        EXPECT_NEAR(read.texels[64 * 31 + 63].y, 2.0f, 0.05f) << name;
    }
    const Panorama reduced = readPanorama(write("large.exr", 2048, 1024, 3, ramp));
    EXPECT_EQ(reduced.width, 1024);
    EXPECT_EQ(reduced.height, 512);
    EXPECT_NEAR(reduced.texels[1024 * 100 + 10].x, 20.5f, 1e-3f) << "the mean of 20 and 21";
    EXPECT_NEAR(readPanorama(write("grey.exr", 8, 4, 1, ramp)).texels[3].z, 3.0f, 1e-3f);
}

TEST_F(EnvironmentFile, ValuesThatAreNoLightBecomeNone) {
    const Panorama read = readPanorama(write("odd.exr", 8, 4, 3, [](int x, int, int) {
        return x == 0   ? std::numeric_limits<float>::quiet_NaN()
               : x == 1 ? std::numeric_limits<float>::infinity()
               : x == 2 ? -3.0f
                        : 1.0f;
    }));
    for (int x = 0; x < 8; ++x)
        EXPECT_EQ(read.texels[static_cast<size_t>(x)].x, x < 3 ? 0.0f : 1.0f);
}

TEST_F(EnvironmentFile, WhatIsNoPanoramaIsRefusedWithItsReason) {
    const auto one = [](int, int, int) { return 1.0f; };
    EXPECT_NE(problem(folder_.path() / "nowhere.exr").find("cannot be opened"), std::string::npos);
    test::writeFile(folder_.path() / "text.hdr", std::string("this is text"));
    EXPECT_NE(problem(folder_.path() / "text.hdr").find("neither OpenEXR nor Radiance"), std::string::npos);
    EXPECT_NE(problem(write("picture.png", 8, 4, 3, one)).find("neither OpenEXR nor Radiance"),
              std::string::npos);
    EXPECT_NE(problem(write("square.exr", 16, 16, 3, one)).find("no panorama"), std::string::npos);
    EXPECT_NE(problem(write("wide.exr", 16400, 4, 1, one)).find("too large"), std::string::npos);
    EXPECT_NE(problem(write("black.exr", 8, 4, 3, [](int, int, int) { return 0.0f; })).find("black"),
              std::string::npos);
    const std::filesystem::path cut = write("cut.exr", 64, 32, 3, one);
    std::filesystem::resize_file(cut, std::filesystem::file_size(cut) / 2);
    EXPECT_NE(problem(cut), "");
    test::writeFile(folder_.path() / "header.exr", std::string("\x76\x2f\x31\x01garbage", 11));
    EXPECT_NE(problem(folder_.path() / "header.exr"), "");
}

} // namespace
} // namespace touchstone

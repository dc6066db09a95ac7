#include "engine/core/error.h"
#include "renderer/picture_file.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace touchstone {
namespace {

class PictureFile : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() / ("touchstone_png_" + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    static PixelData gradient() {
        PixelData pixels;
        pixels.width = 5;
        pixels.height = 3;
        pixels.channels = 4;
        for (int i = 0; i < 60; ++i)
            pixels.bytes.push_back(static_cast<std::byte>(i * 4));
        return pixels;
    }
    [[nodiscard]] size_t filesInFolder() const {
        size_t count = 0;
        for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_))
            ++count;
        return count;
    }
    std::filesystem::path folder_;
};

TEST_F(PictureFile, ReadsBackUnchangedWithTransparency) {
    const PixelData pixels = gradient();
    writePicture(folder_ / "picture.png", pixels);
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    const auto input = OIIO::ImageInput::open((folder_ / "picture.png").string(), &config);
    ASSERT_TRUE(input);
    std::vector<std::byte> read(pixels.bytes.size());
    ASSERT_TRUE(input->read_image(0, 0, 0, 4, OIIO::TypeDesc::UINT8, read.data()));
    EXPECT_EQ(read, pixels.bytes);
    EXPECT_EQ(filesInFolder(), 1u) << "no temporary file is left";
}

/// Of every number of channels, in both depths.
TEST_F(PictureFile, PngHoldsEveryChannelAsItIs) {
    std::mt19937 random(7);
    for (const ComponentType type : {ComponentType::U8, ComponentType::U16})
        for (int channels = 1; channels <= 4; ++channels)
            for (const auto& [width, height] : {std::pair{1, 1}, {7, 3}, {64, 2}}) {
                PixelData pixels{
                    .width = width, .height = height, .channels = channels, .type = type, .bytes = {}};
                const size_t bytes =
                    static_cast<size_t>(width * height * channels) * (type == ComponentType::U8 ? 1 : 2);
                std::generate_n(std::back_inserter(pixels.bytes), bytes,
                                [&] { return static_cast<std::byte>(random()); });
                writePicture(folder_ / "any.png", pixels);
                OIIO::ImageSpec config;
                config.attribute("oiio:UnassociatedAlpha", 1);
                const auto input = OIIO::ImageInput::open((folder_ / "any.png").string(), &config);
                ASSERT_TRUE(input);
                EXPECT_EQ(std::pair(input->spec().width, input->spec().height), std::pair(width, height));
                ASSERT_EQ(input->spec().nchannels, channels);
                EXPECT_EQ(input->spec().get_string_attribute("oiio:ColorSpace"), "sRGB");
                const OIIO::TypeDesc stored =
                    type == ComponentType::U8 ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::UINT16;
                ASSERT_EQ(input->spec().format, stored);
                std::vector<std::byte> read(bytes);
                ASSERT_TRUE(input->read_image(0, 0, 0, channels, stored, read.data()));
                EXPECT_EQ(read, pixels.bytes) << channels << " channels";
            }
}

TEST_F(PictureFile, WhatLibpngRefusesIsAnErrorAndLeavesNothing) {
    PixelData wide{.width = 1'000'001, .height = 1, .channels = 1, .bytes = {}};
    wide.bytes.resize(1'000'001);
    EXPECT_THROW(writePicture(folder_ / "wide.png", wide), Error);
    PixelData five{.width = 1, .height = 1, .channels = 5, .bytes = std::vector<std::byte>(5)};
    EXPECT_THROW(writePicture(folder_ / "five.png", five), Error);
    EXPECT_EQ(filesInFolder(), 0u);
}

TEST_F(PictureFile, MissingFolderNamesFileAndRemedy) {
    try {
        writePicture(folder_ / "nowhere" / "picture.png", gradient());
        FAIL() << "wrote into a folder that does not exist";
    } catch (const Error& error) {
        EXPECT_NE(error.file().find("picture.png"), std::string::npos);
        EXPECT_NE(error.remedy().find("folder"), std::string::npos);
    }
}

TEST_F(PictureFile, FailureLeavesTheOldFileAndNoRubbish) {
    std::filesystem::create_directories(folder_ / "taken.png" / "inside");
    EXPECT_THROW(writePicture(folder_ / "taken.png", gradient()), Error);
    EXPECT_TRUE(std::filesystem::is_directory(folder_ / "taken.png"));
    EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(PictureFile, JpegHoldsThePictureWithoutItsTransparency) {
    PixelData pixels;
    pixels.width = pixels.height = 16;
    pixels.channels = 4;
    for (int i = 0; i < 16 * 16; ++i)
        for (const int value : {200, 120, 40, 255})
            pixels.bytes.push_back(static_cast<std::byte>(value));
    for (const char* name : {"a.jpg", "b.JPEG", "c.Jpg"}) {
        EXPECT_EQ(pictureNameProblem(folder_ / name), "");
        writePicture(folder_ / name, pixels);
        const auto input = OIIO::ImageInput::open((folder_ / name).string());
        ASSERT_TRUE(input) << name;
        EXPECT_STREQ(input->format_name(), "jpeg");
        EXPECT_EQ(input->spec().nchannels, 3);
        std::vector<unsigned char> read(16 * 16 * 3);
        ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, read.data()));
        EXPECT_NEAR(read[0], 200, 3);
        EXPECT_NEAR(read[1], 120, 3);
        EXPECT_NEAR(read[2], 40, 3);
    }
    EXPECT_EQ(filesInFolder(), 3u);
}

TEST_F(PictureFile, OtherEndingsAreRefusedWithTheOnesThatAreWritten) {
    for (const char* name : {"picture.gif", "picture", "png", "picture.png.txt", ".png"}) {
        EXPECT_NE(pictureNameProblem(folder_ / name), "") << name;
        try {
            writePicture(folder_ / name, gradient());
            FAIL() << name;
        } catch (const Error& error) {
            EXPECT_NE(error.remedy().find(".jpg"), std::string::npos) << error.what();
            EXPECT_NE(error.remedy().find(".png"), std::string::npos) << error.what();
        }
    }
    EXPECT_EQ(filesInFolder(), 0u);
}

/// A full disk, by a link to the device that is one: the device stays, and nothing is left beside it.
TEST_F(PictureFile, AFullDiskIsAnErrorAndLeavesNothing) {
    for (const char* name : {"full.png", "full.jpg"}) {
        std::filesystem::create_symlink("/dev/full", folder_ / name);
        EXPECT_THROW(writePicture(folder_ / name, gradient()), Error) << name;
        EXPECT_TRUE(std::filesystem::is_symlink(folder_ / name));
    }
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
    EXPECT_EQ(filesInFolder(), 2u);
    EXPECT_THROW(writePicture("/proc/picture.png", gradient()), Error) << "nobody writes there";
}

TEST_F(PictureFile, NothingToWriteIsAnError) {
    EXPECT_THROW(writePicture(folder_ / "empty.png", PixelData{}), Error);
    EXPECT_EQ(filesInFolder(), 0u);
}

} // namespace
} // namespace touchstone

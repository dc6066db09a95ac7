#include "engine/core/error.h"
#include "renderer/png.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>

namespace touchstone {
namespace {

class WritePng : public ::testing::Test {
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

TEST_F(WritePng, ReadsBackUnchangedWithTransparency) {
    const PixelData pixels = gradient();
    writePng(folder_ / "picture.png", pixels);
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    const auto input = OIIO::ImageInput::open((folder_ / "picture.png").string(), &config);
    ASSERT_TRUE(input);
    std::vector<std::byte> read(pixels.bytes.size());
    ASSERT_TRUE(input->read_image(0, 0, 0, 4, OIIO::TypeDesc::UINT8, read.data()));
    EXPECT_EQ(read, pixels.bytes);
    EXPECT_EQ(filesInFolder(), 1u) << "no temporary file is left";
}

TEST_F(WritePng, MissingFolderNamesFileAndRemedy) {
    try {
        writePng(folder_ / "nowhere" / "picture.png", gradient());
        FAIL() << "wrote into a folder that does not exist";
    } catch (const Error& error) {
        EXPECT_NE(error.file().find("picture.png"), std::string::npos);
        EXPECT_NE(error.remedy().find("folder"), std::string::npos);
    }
}

TEST_F(WritePng, FailureLeavesTheOldFileAndNoRubbish) {
    std::filesystem::create_directories(folder_ / "taken.png" / "inside");
    EXPECT_THROW(writePng(folder_ / "taken.png", gradient()), Error);
    EXPECT_TRUE(std::filesystem::is_directory(folder_ / "taken.png"));
    EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(WritePng, NothingToWriteIsAnError) {
    EXPECT_THROW(writePng(folder_ / "empty.png", PixelData{}), Error);
    EXPECT_EQ(filesInFolder(), 0u);
}

} // namespace
} // namespace touchstone

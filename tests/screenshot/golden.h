#pragma once
// Pictures against the ones that we looked at and kept: tests/screenshot/golden/NAME.png.

#include "engine/scene/image.h"
#include "renderer/picture_file.h"
#include "tests/support/picture.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace touchstone::test {

/// The tolerance: at most 0.5 % of the pixels may fail. One device repeats itself bit by bit; the room, and
/// that of a pixel (kPixelTolerance), is for other versions of Mesa and other vector widths, which round
/// differently along edges.
inline constexpr double kFailingShare = 0.005;

inline std::filesystem::path goldenFile(const std::string& name) {
    return std::filesystem::path(TOUCHSTONE_SOURCE) / "tests/screenshot/golden" / (name + ".png");
}

inline double differenceFromGolden(const std::string& name, const PixelData& pixels) {
    if (!std::filesystem::exists(goldenFile(name))) {
        ADD_FAILURE() << "there is no " << goldenFile(name)
                      << "; run with UPDATE_GOLDEN=1 and look at what it wrote";
        return 1.0;
    }
    return failingShare(pixels, readPicture(goldenFile(name)));
}

/// With UPDATE_GOLDEN=1 in the environment the picture becomes the golden one: look at it before committing.
inline void expectMatchesGolden(const std::string& name, const PixelData& pixels,
                                double most = kFailingShare) {
    if (std::getenv("UPDATE_GOLDEN") != nullptr)
        writePicture(goldenFile(name), pixels);
    const double share = differenceFromGolden(name, pixels);
    EXPECT_LE(share, most) << name << " differs from its golden picture";
    if (share > most) {
        const std::filesystem::path actual =
            std::filesystem::temp_directory_path() / ("actual_" + name + ".png");
        writePicture(actual, pixels);
        ADD_FAILURE() << "see " << actual << " and " << goldenFile(name);
    }
}

/// A picture with a mistake in it must be told from the golden one, else the golden one guards nothing.
inline void expectMutationIsSeen(const std::string& name, const std::string& mutation,
                                 const PixelData& pixels, double most = kFailingShare) {
    EXPECT_GT(differenceFromGolden(name, pixels), most) << name << " does not notice: " << mutation;
}

} // namespace touchstone::test

#pragma once
// Pictures against the ones that we looked at and kept: tests/screenshot/golden/NAME.png.

#include "engine/scene/image.h"
#include "renderer/picture_file.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace touchstone::test {

/// The tolerance: a pixel fails when a channel differs by more than 6 of 255; at most 0.5 % of the pixels may
/// fail. One device repeats itself bit by bit; the room is for other versions of Mesa and other vector
/// widths, which round differently along edges.
inline constexpr float kPixelTolerance = 6.0f / 255.0f;
inline constexpr double kFailingShare = 0.005;

inline std::filesystem::path goldenFile(const std::string& name) {
    return std::filesystem::path(TOUCHSTONE_SOURCE) / "tests/screenshot/golden" / (name + ".png");
}

inline OIIO::ImageBuf asImageBuf(const PixelData& pixels) {
    const OIIO::ImageSpec spec(pixels.width, pixels.height, pixels.channels, OIIO::TypeDesc::UINT8);
    return OIIO::ImageBuf(spec, const_cast<std::byte*>(pixels.bytes.data()));
}

/// Share of failing pixels between two pictures; 1 where the sizes differ.
inline double failingShare(const OIIO::ImageBuf& a, const OIIO::ImageBuf& b) {
    if (a.spec().width != b.spec().width || a.spec().height != b.spec().height)
        return 1.0;
    const OIIO::ImageBufAlgo::CompareResults result =
        OIIO::ImageBufAlgo::compare(a, b, kPixelTolerance, kPixelTolerance);
    return static_cast<double>(result.nfail) / (static_cast<double>(a.spec().width) * a.spec().height);
}

inline double failingShare(const PixelData& a, const PixelData& b) {
    return failingShare(asImageBuf(a), asImageBuf(b));
}

inline double differenceFromGolden(const std::string& name, const PixelData& pixels) {
    OIIO::ImageBuf golden(goldenFile(name).string());
    if (!golden.read(0, 0, true, OIIO::TypeDesc::UINT8)) {
        ADD_FAILURE() << "cannot read " << goldenFile(name) << ": " << golden.geterror()
                      << "; run with UPDATE_GOLDEN=1 and look at what it wrote";
        return 1.0;
    }
    return failingShare(asImageBuf(pixels), golden);
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

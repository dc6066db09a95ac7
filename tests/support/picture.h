#pragma once
// Pictures as tests compare them. They are read by the program's own image library, which a test loads where
// it needs it: a program that links OpenImageIO takes 0.2 s of processor time to start, in each of its cases.

#include "engine/scene/image.h"

#include <filesystem>

namespace touchstone::test {

/// The tolerance: a pixel fails when a channel differs by more than 6 of 255.
inline constexpr float kPixelTolerance = 6.0f / 255.0f;

/// The pixels as the file holds them, rows from the top. Without any, and with a failure of the test, where
/// it cannot be read.
[[nodiscard]] PixelData readPicture(const std::filesystem::path& file);

/// Share of failing pixels between two pictures; 1 where their sizes or channels differ.
[[nodiscard]] double failingShare(const PixelData& a, const PixelData& b);

/// Mean difference of the first `channels` channels of two pictures, 0..1. 1, and a failure of the test,
/// where their sizes differ, they have fewer channels, or no pixels.
[[nodiscard]] double meanDifference(const PixelData& a, const PixelData& b, int channels);

} // namespace touchstone::test

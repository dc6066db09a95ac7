#pragma once

#include "engine/scene/image.h"

#include <filesystem>
#include <string>

namespace touchstone {

/// Why no picture can be written under this name: its ending is none of .png, .jpg and .jpeg, in either case.
/// Empty: it can.
[[nodiscard]] std::string pictureNameProblem(const std::filesystem::path& file);

/// Writes pixels in the format that the file's ending names: PNG of 8 or 16 bit with transparency, or JPEG of
/// 8 bit (quality 95) without. All or nothing, as OutputFile does it: no part of a picture is left behind.
/// Any thread. Throws Error for another ending, where there is nothing to write, and where the file cannot be
/// written.
void writePicture(const std::filesystem::path& file, const PixelData& pixels);

} // namespace touchstone

#pragma once

#include "engine/scene/image.h"

#include <filesystem>

namespace touchstone {

/// Writes 8 or 16 bit pixels as PNG, atomically, through a temporary file beside it. Any thread. Throws Error
/// when the folder is missing or not writable.
void writePng(const std::filesystem::path& file, const PixelData& pixels);

} // namespace touchstone

#pragma once

#include "engine/scene/image.h"

#include <vector>

namespace touchstone {

/// The bytes of a PNG file of 8 or 16 bit a channel, sRGB, alpha not premultiplied. By libpng: OpenImageIO
/// and its 260 libraries take 0.2 s to load, longer than most pictures take to draw. `pixels`: integers, 1 to
/// 4 channels, at least one pixel. Empty where libpng refuses (a side of more than 1,000,000 pixels) or
/// memory runs out. Any thread.
[[nodiscard]] std::vector<unsigned char> encodePng(const PixelData& pixels);

} // namespace touchstone

#pragma once
// An image of the scene in the device's format: four channels, all mip levels. Pure; any thread.

#include "engine/scene/image.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace touchstone {

/// Color holds sRGB values (base colour, emission) and is averaged in linear light; Data is linear.
enum class TextureRole : uint8_t { Color, Data };

enum class TexelFormat : uint8_t { Srgb8, Unorm8, Half16 }; ///< 4 channels each

struct TextureLevels {
    struct Level {
        int width = 0, height = 0;
        size_t offset = 0; ///< in `bytes`
    };
    TexelFormat format = TexelFormat::Unorm8;
    std::vector<Level> levels; ///< from the largest, each half the previous one, down to 1 x 1
    std::vector<std::byte> bytes;
};

[[nodiscard]] constexpr size_t bytesPerTexel(TexelFormat format) {
    return format == TexelFormat::Half16 ? 8 : 4;
}

/// One channel is grey, two are grey and alpha. Color becomes 8 bit sRGB; Data of 16 bits or float becomes
/// half floats, with 11 bits of precision. Where `pixels` is larger than `largestSide`, the largest levels
/// are omitted. Pixels must not be empty.
[[nodiscard]] TextureLevels buildTextureLevels(const PixelData& pixels, TextureRole role, int largestSide);

} // namespace touchstone

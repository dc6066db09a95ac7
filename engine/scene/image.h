#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace touchstone {

enum class ComponentType : uint8_t { U8, U16, F32 };

/// Decoded pixels, rows from the top as in glTF's UV origin, channels interleaved, no padding. Values are as
/// stored in the file, without colour conversion (haptic maps are linear data; the renderer decodes sRGB).
struct PixelData {
    int width = 0, height = 0;
    int channels = 0; ///< 1..4
    ComponentType type = ComponentType::U8;
    std::vector<std::byte> bytes; ///< width * height * channels * componentSize

    /// Channel `c` at column x, row y, as 0..1 for integer types and as stored for float. No bounds check.
    [[nodiscard]] float value(int x, int y, int c) const {
        const size_t index = (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)) *
                                 static_cast<size_t>(channels) +
                             static_cast<size_t>(c);
        switch (type) {
        case ComponentType::U8:
            return static_cast<float>(std::to_integer<uint8_t>(bytes[index])) / 255.0f;
        case ComponentType::U16: {
            uint16_t stored = 0;
            std::memcpy(&stored, &bytes[2 * index], sizeof stored);
            return static_cast<float>(stored) / 65535.0f;
        }
        case ComponentType::F32:
            break;
        }
        float stored = 0.0f;
        std::memcpy(&stored, &bytes[4 * index], sizeof stored);
        return stored;
    }
};

/// An image of the file. `pixels` is empty when it is not needed or broken (`problem` states why).
struct Image {
    std::string name;                        ///< name for messages: name, URI or "images[3]"
    int width = 0, height = 0, channels = 0; ///< from its header, decoded or not
    PixelData pixels;
    std::string problem;
    bool decoded = false;
    uint64_t encodedBytes = 0;
};

} // namespace touchstone

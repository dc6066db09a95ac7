#include "engine/scene/image.h"

#include <cstring>

namespace touchstone {

float PixelData::value(int x, int y, int c) const {
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

} // namespace touchstone

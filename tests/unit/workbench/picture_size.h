#pragma once

#include <cstdint>
#include <string>
#include <utility>

namespace touchstone::test {

/// Width and height in a PNG's header; zeros where it is none.
inline std::pair<uint32_t, uint32_t> pngSize(const std::string& bytes) {
    if (bytes.size() < 24 || bytes.substr(1, 3) != "PNG")
        return {0, 0};
    const auto number = [&](size_t at) {
        uint32_t value = 0;
        for (size_t i = 0; i < 4; ++i)
            value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
        return value;
    };
    return {number(16), number(20)};
}

} // namespace touchstone::test

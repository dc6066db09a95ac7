#include "server/messages.h"

#include <cstdint>

namespace touchstone::server {

std::string decodedBase64(std::string_view text) {
    std::string bytes;
    uint32_t word = 0;
    int bits = 0;
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (const char c : text.substr(0, text.find('='))) {
        const size_t digit = kDigits.find(c);
        if (digit == std::string_view::npos)
            throw Refusal("'bytes' is not base64");
        word = (word << 6) | static_cast<uint32_t>(digit);
        if ((bits += 6) >= 8)
            bytes.push_back(static_cast<char>(word >> (bits -= 8)));
    }
    return bytes;
}

} // namespace touchstone::server

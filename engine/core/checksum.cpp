#include "engine/core/checksum.h"

#include <nmmintrin.h>

#include <algorithm>

namespace touchstone {

uint32_t crc32c(std::span<const std::byte> bytes, uint32_t before) noexcept {
    uint64_t crc = ~before;
    const std::byte* at = bytes.data();
    size_t left = bytes.size();
    for (; left >= 8; left -= 8, at += 8) {
        uint64_t word = 0;
        std::memcpy(&word, at, 8);
        crc = _mm_crc32_u64(crc, word);
    }
    for (; left > 0; --left, ++at)
        crc = _mm_crc32_u8(static_cast<uint32_t>(crc), static_cast<unsigned char>(*at));
    return ~static_cast<uint32_t>(crc);
}

void Hash64::addBytes(std::span<const std::byte> bytes) noexcept {
    addWord(bytes.size());
    for (size_t at = 0; at < bytes.size(); at += 8) {
        uint64_t word = 0;
        std::memcpy(&word, bytes.data() + at, std::min<size_t>(8, bytes.size() - at));
        addWord(word);
    }
}

FileStamp stampOf(std::span<const uint8_t> bytes) noexcept {
    Hash64 hash;
    hash.addBytes(std::as_bytes(bytes));
    return {bytes.size(), hash.value()};
}

} // namespace touchstone

#include "haptics/recording/byte_stream.h"

namespace touchstone {

// Out of line: inlined, g++ 12 warns of overflows that cannot occur.
void ByteWriter::put(std::span<const std::byte> bytes) {
    const size_t at = bytes_.size();
    bytes_.resize(at + bytes.size());
    if (!bytes.empty())
        std::memcpy(bytes_.data() + at, bytes.data(), bytes.size());
}

} // namespace touchstone

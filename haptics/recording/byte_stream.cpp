#include "haptics/recording/byte_stream.h"

namespace touchstone {

// Out of line: inlined, g++ 12 sees overflows that are not there.
void ByteWriter::put(std::span<const std::byte> bytes) {
    const size_t at = bytes_.size();
    bytes_.resize(at + bytes.size());
    if (!bytes.empty())
        std::memcpy(bytes_.data() + at, bytes.data(), bytes.size());
}

} // namespace touchstone

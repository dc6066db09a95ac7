#pragma once
// Two checks whether bytes are unchanged. Neither protects against deliberate tampering.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace touchstone {

/// CRC-32C (Castagnoli, reflected, 0x82f63b78; initial value and final inversion as in RFC 3720) of the
/// bytes; `before`: the CRC of the preceding bytes. Any thread.
[[nodiscard]] uint32_t crc32c(std::span<const std::byte> bytes, uint32_t before = 0) noexcept;

/// A hash of 64-bit words in order: for each, state = (state ^ word) * 0x9e3779b97f4a7c15, then
/// state ^= state >> 32. Starts from 0x243f6a8885a308d3. Any thread.
class Hash64 {
  public:
    /// Numbers of up to eight bytes are one word: integers extended, floating-point numbers by their bits as
    /// double.
    template <class Number>
    requires std::is_arithmetic_v<Number> || std::is_enum_v<Number>
    void add(Number number) noexcept {
        uint64_t word = 0;
        if constexpr (std::is_floating_point_v<Number>) {
            const auto real = static_cast<double>(number);
            std::memcpy(&word, &real, sizeof word);
        } else {
            word = static_cast<uint64_t>(number);
        }
        addWord(word);
    }
    /// Their number, then the bytes, eight to a word, the last word padded with zeros.
    void addBytes(std::span<const std::byte> bytes) noexcept;
    /// For types without padding.
    template <class Plain>
    requires std::is_trivially_copyable_v<Plain>
    void addBytes(const std::vector<Plain>& values) noexcept { addBytes(std::as_bytes(std::span(values))); }

    [[nodiscard]] uint64_t value() const noexcept { return state_; }
    /// The upper half of one more product: in the lower halves the last word's sign would cancel out.
    [[nodiscard]] uint32_t folded() const noexcept { return static_cast<uint32_t>((state_ * kFactor) >> 32); }

  private:
    void addWord(uint64_t word) noexcept {
        state_ = (state_ ^ word) * kFactor;
        state_ ^= state_ >> 32;
    }
    static constexpr uint64_t kFactor = 0x9e3779b97f4a7c15u;
    uint64_t state_ = 0x243f6a8885a308d3u;
};

/// Size and hash of a file's bytes, to recognise it.
struct FileStamp {
    uint64_t size = 0; ///< bytes
    uint64_t hash = 0; ///< Hash64 of them
    bool operator==(const FileStamp&) const = default;
};
[[nodiscard]] FileStamp stampOf(std::span<const uint8_t> bytes) noexcept;

} // namespace touchstone

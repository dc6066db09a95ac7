#pragma once
// Serialisation of numbers and texts: little endian, without padding.

#include "engine/core/error.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace touchstone {

static_assert(std::endian::native == std::endian::little, "recordings are little endian");

class ByteWriter {
  public:
    explicit ByteWriter(std::vector<std::byte>& bytes) : bytes_(bytes) {}

    template <class Number>
    requires std::is_arithmetic_v<Number>
    void put(Number number) { put(std::as_bytes(std::span(&number, 1))); }
    void put(const glm::dvec3& v) {
        put(v.x);
        put(v.y);
        put(v.z);
    }
    void put(const glm::dquat& q) {
        put(q.x);
        put(q.y);
        put(q.z);
        put(q.w);
    }
    /// Length (u32), then UTF-8.
    void put(std::string_view text) {
        put(static_cast<uint32_t>(text.size()));
        put(std::as_bytes(std::span(text)));
    }
    void put(const std::string& text) { put(std::string_view(text)); }
    void put(std::span<const std::byte> bytes);

  private:
    std::vector<std::byte>& bytes_;
};

/// Throws Error at the end of the bytes.
class ByteReader {
  public:
    explicit ByteReader(std::span<const std::byte> bytes) : left_(bytes) {}

    template <class Number>
    requires std::is_arithmetic_v<Number>
    void get(Number& number) {
        if constexpr (std::is_same_v<Number, bool>) // any byte but 0 and 1 would be no bool
            number = take(1)[0] != std::byte{0};
        else
            std::memcpy(&number, take(sizeof number).data(), sizeof number);
    }
    void get(glm::dvec3& v) {
        get(v.x);
        get(v.y);
        get(v.z);
    }
    void get(glm::dquat& q) {
        get(q.x);
        get(q.y);
        get(q.z);
        get(q.w);
    }
    void get(std::string& text) {
        uint32_t size = 0;
        get(size);
        const std::span<const std::byte> bytes = take(size);
        text.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    }
    std::span<const std::byte> take(size_t size) {
        if (size > left_.size())
            throw Error("", "", "ends too early", "");
        const std::span<const std::byte> taken = left_.first(size);
        left_ = left_.subspan(size);
        return taken;
    }
    [[nodiscard]] size_t left() const { return left_.size(); }

  private:
    std::span<const std::byte> left_;
};

} // namespace touchstone

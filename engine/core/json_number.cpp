#include "engine/core/json_number.h"

#include <nlohmann/json.hpp>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace touchstone {

nlohmann::ordered_json jsonOf(float value) {
    constexpr float kExactlyWhole = 1e9f;
    if (std::abs(value) < kExactlyWhole && value == std::floor(value))
        return static_cast<int64_t>(value);
    std::array<char, 32> text{};
    const char* const end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    double number = 0.0;
    std::from_chars(text.data(), end, number);
    return number;
}

} // namespace touchstone

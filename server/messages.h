#pragma once
// What clients' messages are made of.

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone::server {

using Json = nlohmann::json;

/// A message that is refused; becomes the answer's `error`.
struct Refusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Throws Refusal.
template <class T>
[[nodiscard]] T member(const Json& message, const char* name) {
    const auto found = message.find(name);
    if (found == message.end())
        throw Refusal(std::string("'") + name + "' is missing");
    try {
        return found->get<T>();
    } catch (const Json::exception&) {
        throw Refusal(std::string("'") + name + "' is of the wrong type");
    }
}
template <class T>
[[nodiscard]] T memberOr(const Json& message, const char* name, const T& otherwise) {
    return message.contains(name) ? member<T>(message, name) : otherwise;
}
/// The number of an object or a material. Throws Refusal.
[[nodiscard]] inline uint64_t numberIn(const Json& message, const char* name) {
    const auto number = member<int64_t>(message, name);
    if (number < 0)
        throw Refusal(std::string("'") + name + "' is negative");
    return static_cast<uint64_t>(number);
}

/// Throws Refusal where there are not `Count` numbers.
template <size_t Count>
void numbersOf(const std::vector<double>& from, double (&to)[Count], const char* name) {
    if (from.size() != Count)
        throw Refusal(std::string("'") + name + "' is not " + (Count == 3 ? "three" : "four") + " numbers");
    std::ranges::copy(from, to);
}

/// Throws Refusal.
[[nodiscard]] std::string decodedBase64(std::string_view text);

[[nodiscard]] inline Json vectorOf(const double (&v)[3]) {
    return {v[0], v[1], v[2]};
}
/// NaN is no number of JSON's.
[[nodiscard]] inline Json numberOrNull(double value) {
    return value == value ? Json(value) : Json();
}
/// Texts of files need not be UTF-8.
[[nodiscard]] inline std::string textOf(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

} // namespace touchstone::server

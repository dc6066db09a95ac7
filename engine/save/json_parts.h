#pragma once
// JSON as text: where the parts of an object or array lie, and how to change one and leave all others as they
// are, digit by digit. A document that is parsed and written again has other numbers: "1.0" becomes "1", and
// what a double does not hold is lost.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone {

/// A direct child of an object or array, as offsets into its text.
struct JsonPart {
    std::string key;           ///< decoded; empty in arrays
    size_t keyBegin = 0;       ///< of the key's first quote; in arrays where the value begins
    size_t begin = 0, end = 0; ///< of the value
    [[nodiscard]] std::string_view of(std::string_view text) const { return text.substr(begin, end - begin); }
};

/// The children of `text`, in order. It must be valid JSON (with or without a byte order mark) and an object
/// or an array; anything else has no children. Any thread.
[[nodiscard]] std::vector<JsonPart> jsonParts(std::string_view text);

/// The child that counts: of equal keys the last one, as the importer's parser has it.
[[nodiscard]] std::optional<JsonPart> jsonMember(std::string_view text, std::string_view key);

/// The object `text` with the member `key` set to `value` (JSON). A new one comes last, on a line of its own
/// where the others have one.
[[nodiscard]] std::string withMember(std::string_view text, std::string_view key, std::string_view value);

/// The object without any member of that key, or the array without any string element that equals `key`.
[[nodiscard]] std::string withoutMember(std::string_view text, std::string_view key);

/// The array with `value` (JSON) behind its last element.
[[nodiscard]] std::string withElement(std::string_view text, std::string_view value);

/// How many keys of any object in `text`, however deep, are `key`.
[[nodiscard]] size_t countKeys(std::string_view text, std::string_view key);

} // namespace touchstone

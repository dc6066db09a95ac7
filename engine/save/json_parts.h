#pragma once
// JSON as text: locates the parts of an object or array, and changes one of them while all others stay the
// same, digit by digit. A document that is parsed and written again has other numbers: "1.0" becomes "1", and
// digits beyond a double are lost.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone {

/// A direct child of an object or array, as offsets into its text.
struct JsonPart {
    std::string key;           ///< decoded; empty in arrays
    size_t keyBegin = 0;       ///< of the key's first quote; in arrays of the value
    size_t begin = 0, end = 0; ///< of the value
    [[nodiscard]] std::string_view of(std::string_view text) const { return text.substr(begin, end - begin); }
};

/// The children of `text`, in order. It must be valid JSON (with or without a byte order mark) and an object
/// or an array; anything else has no children. Any thread.
[[nodiscard]] std::vector<JsonPart> jsonParts(std::string_view text);

/// The effective child: of equal keys the last one, as in the importer's parser.
[[nodiscard]] std::optional<JsonPart> jsonMember(std::string_view text, std::string_view key);

/// The object `text` with the member `key` set to `value` (JSON). A new one is added last, on a line of its
/// own where the others have one.
[[nodiscard]] std::string withMember(std::string_view text, std::string_view key, std::string_view value);

/// The object without any member of that key, or the array without any string element that equals `key`.
[[nodiscard]] std::string withoutMember(std::string_view text, std::string_view key);

/// The array with `value` (JSON) after its last element.
[[nodiscard]] std::string withElement(std::string_view text, std::string_view value);

/// The number of keys equal to `key` in all objects in `text`, at any depth.
[[nodiscard]] size_t countKeys(std::string_view text, std::string_view key);

} // namespace touchstone

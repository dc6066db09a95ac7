#pragma once
// The fields of a plain struct as data: one table from which the command line, `--help`, the window's memory,
// figures and recordings are made. Not for the servo thread.

#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace touchstone {

/// How a field is named, bounded and written, whatever struct it belongs to.
struct FieldText {
    std::string_view name, unit;
    /// One of these words, in the order of the field's values; empty: a number.
    std::span<const std::string_view> words;
    double low, high;   ///< allowed range of a number, in `unit`
    double scale = 1.0; ///< SI units in one `unit`
    bool whole = false; ///< a number without a fraction
    std::string_view meaning;
};

/// "sweep, rays" or "0 .. 0.05".
[[nodiscard]] std::string allowedValues(const FieldText& field);
/// `value` (SI, or the number of a word) as `readValue` takes it; it reads back to the last bit if it was
/// read from a text.
[[nodiscard]] std::string writtenValue(const FieldText& field, double value);
/// Reads a word or a number in the field's unit. False if it is none or outside the range; then `value` is
/// unchanged.
[[nodiscard]] bool readValue(const FieldText& field, std::string_view text, double& value);
/// "'x' is not a value of NAME; allowed: 0 .. 1 N".
[[nodiscard]] std::string refusedValue(const FieldText& field, std::string_view text);

/// A field of S.
template <class S>
struct StructField : FieldText {
    double (*get)(const S&); ///< SI, or the number of a word
    void (*set)(S&, double); ///< a value that `readValue` gives
};

/// A StructField from a pointer to its member.
template <auto Member, class S>
constexpr StructField<S> fieldOf(const FieldText& text) {
    using Value = std::remove_cvref_t<decltype(std::declval<S>().*Member)>;
    return {text, [](const S& s) { return static_cast<double>(s.*Member); },
            [](S& s, double value) {
                if constexpr (std::is_same_v<Value, bool>)
                    s.*Member = value != 0.0;
                else
                    s.*Member = static_cast<Value>(value);
            }};
}

/// The field of that name; null if there is none.
template <class S>
[[nodiscard]] const StructField<S>* findField(std::span<const StructField<S>> fields, std::string_view name) {
    for (const StructField<S>& field : fields)
        if (field.name == name)
            return &field;
    return nullptr;
}

/// Every name, ", " between them.
template <class S>
[[nodiscard]] std::string fieldNames(std::span<const StructField<S>> fields) {
    std::string names;
    for (const StructField<S>& field : fields)
        names += (names.empty() ? "" : ", ") + std::string(field.name);
    return names;
}

} // namespace touchstone

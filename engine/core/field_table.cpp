#include "engine/core/field_table.h"

#include <array>
#include <charconv>
#include <cmath>

namespace touchstone {

namespace {

/// Digits that any double reads back from.
constexpr int kExact = 17;

std::string text(double number) {
    std::array<char, 32> buffer{};
    const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
    return {buffer.data(), result.ptr};
}

double read(const std::string& written) {
    double number = 0.0;
    std::from_chars(written.data(), written.data() + written.size(), number);
    return number;
}

/// A bound of a range, without an exponent where it is no longer than a person reads.
std::string bound(double number) {
    std::array<char, 32> buffer{};
    const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number,
                                      std::chars_format::general, kExact - 1);
    return {buffer.data(), result.ptr};
}

} // namespace

std::string allowedValues(const FieldText& field) {
    if (field.words.empty())
        return bound(field.low) + " .. " + bound(field.high);
    std::string all;
    for (const std::string_view word : field.words)
        all += (all.empty() ? "" : ", ") + std::string(word);
    return all;
}

std::string writtenValue(const FieldText& field, double value) {
    if (!field.words.empty())
        return std::string(field.words[static_cast<size_t>(value)]);
    if (field.scale == 1.0)
        return text(value);
    // The quotient may be off by its last digit: 12 digits where they give the same SI value, else the
    // neighbour that does.
    const double exact = value / field.scale;
    std::array<char, 32> buffer{};
    const auto result =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), exact, std::chars_format::general, 12);
    for (const double candidate : {read({buffer.data(), result.ptr}), exact, std::nextafter(exact, INFINITY),
                                   std::nextafter(exact, -INFINITY)})
        if (candidate * field.scale == value)
            return text(candidate);
    return text(exact);
}

bool readValue(const FieldText& field, std::string_view text, double& value) {
    for (size_t i = 0; i < field.words.size(); ++i)
        if (field.words[i] == text) {
            value = static_cast<double>(i);
            return true;
        }
    if (!field.words.empty())
        return false;
    double number = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size() ||
        !(number >= field.low && number <= field.high) || (field.whole && number != std::floor(number)))
        return false;
    value = number * field.scale;
    return true;
}

std::string refusedValue(const FieldText& field, std::string_view text) {
    return "'" + std::string(text) + "' is not a value of " + std::string(field.name) +
           "; allowed: " + allowedValues(field) + (field.unit.empty() ? "" : " " + std::string(field.unit));
}

} // namespace touchstone

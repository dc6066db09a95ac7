#pragma once
// Rows of a field table from pointers to members (engine/core/field_table.h). For the sources that have a
// table.

#include "engine/core/field_table.h"

#include <type_traits>

namespace touchstone {

namespace detail {

template <class S, class Value>
S ownerOf(Value S::*);
template <class S, class Value>
Value valueOf(Value S::*);

inline constexpr std::string_view kSwitchWords[]{"off", "on"};

} // namespace detail

/// One of `words`, in the order of the member's values.
template <auto Member>
constexpr auto wordField(std::string_view name, std::span<const std::string_view> words,
                         std::string_view meaning) {
    return fieldOf<Member, decltype(detail::ownerOf(Member))>({.name = name,
                                                               .unit = "",
                                                               .words = words,
                                                               .low = 0.0,
                                                               .high = static_cast<double>(words.size() - 1),
                                                               .whole = true,
                                                               .meaning = meaning});
}

/// off or on.
template <auto Member>
constexpr auto switchField(std::string_view name, std::string_view meaning) {
    return wordField<Member>(name, detail::kSwitchWords, meaning);
}

/// A number between `low` and `high`, in `unit`, which is `scale` SI units.
template <auto Member>
constexpr auto numberField(std::string_view name, std::string_view unit, double low, double high,
                           std::string_view meaning, double scale = 1.0) {
    return fieldOf<Member, decltype(detail::ownerOf(Member))>(
        {.name = name,
         .unit = unit,
         .words = {},
         .low = low,
         .high = high,
         .scale = scale,
         .whole = std::is_integral_v<decltype(detail::valueOf(Member))>,
         .meaning = meaning});
}

} // namespace touchstone

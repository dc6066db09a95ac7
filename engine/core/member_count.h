#pragma once

#include <cstddef>
#include <utility>

namespace touchstone {

namespace detail {

/// Converts to whatever type a member has; only for counting the members of an aggregate.
struct AnyMember {
    template <class T>
    operator T() const; // NOLINT: implicit on purpose
};

template <class T, size_t... I>
constexpr bool takesMembers(std::index_sequence<I...>) {
    return requires {
        T{(static_cast<void>(I), AnyMember{})...};
    };
}

} // namespace detail

/// Number of data members of the aggregate T. A list of its fields that asserts this number does not compile
/// while a member is missing from the list.
template <class T, size_t N = 0>
constexpr size_t memberCount() {
    if constexpr (detail::takesMembers<T>(std::make_index_sequence<N + 1>{}))
        return memberCount<T, N + 1>();
    else
        return N;
}

} // namespace touchstone

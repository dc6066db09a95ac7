#pragma once
// What every function of the C interface does around its work: sizes of structs, texts, errors.

#include "api/c/handles.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone::api {

/// For ts_last_error of this thread.
void remember(const char* message) noexcept;
/// The status of the exception that is being handled; its message is remembered.
[[nodiscard]] ts_status statusOfException() noexcept;

/// Runs `work`, whatever it throws.
template <class Work>
[[nodiscard]] ts_status call(Work&& work) noexcept {
    try {
        work();
        return TS_OK;
    } catch (...) {
        return statusOfException();
    }
}

/// `pointer` is not null.
template <class T>
T& given(T* pointer, const char* argument) {
    if (pointer == nullptr)
        refuseArgument(argument, "is null");
    return *pointer;
}

/// The size that a struct of the caller states. Throws Refused where no compiler gives it, so that no member
/// is cut in two.
template <class T>
[[nodiscard]] size_t sizeOf(const T& given_, const char* argument) {
    constexpr size_t kLargest = 4096;
    const size_t size = given_.size;
    if (size < sizeof(size_t) || size > kLargest || size % alignof(T) != 0)
        refuseArgument(argument, "its size is " + std::to_string(size) + "; begin with TS_STRUCT");
    return size;
}

/// A struct of the caller as this version knows it: members that the caller does not have are zero. Throws
/// Refused where its size is none, and where it has members beyond ours that are not zero. Null: `absent`.
template <class T>
[[nodiscard]] T structOf(const T* from, const char* argument, const T& absent = {}) {
    if (from == nullptr)
        return absent;
    T value{};
    const size_t size = sizeOf(*from, argument);
    const auto* bytes = reinterpret_cast<const unsigned char*>(from);
    for (size_t i = sizeof(T); i < size; ++i)
        if (bytes[i] != 0)
            refuseArgument(argument, "has members that this version does not know");
    std::memcpy(&value, bytes, std::min(size, sizeof(T)));
    value.size = sizeof(T);
    return value;
}
/// The name of an entry of an array, for messages.
[[nodiscard]] inline std::string entry(const char* array, size_t i) {
    return std::string(array) + "[" + std::to_string(i) + "]";
}
/// Structs of a caller's array: the first one's size is the distance to the next.
template <class T>
[[nodiscard]] std::vector<T> structsOf(const T* array, size_t count, const char* argument) {
    std::vector<T> structs;
    if (count == 0)
        return structs;
    const size_t stride = sizeOf(given(array, argument), argument);
    const auto* at = reinterpret_cast<const unsigned char*>(array);
    constexpr size_t kMost = 20'000; // as many as the reader of mesh files takes
    if (count > kMost)
        refuseArgument(argument, std::to_string(count) + " of them; at most " + std::to_string(kMost));
    for (size_t i = 0; i < count; ++i, at += stride)
        structs.push_back(structOf(reinterpret_cast<const T*>(at), entry(argument, i).c_str()));
    return structs;
}
/// Writes what the caller has room for and keeps his size.
template <class T>
void giveStruct(const T& value, T* to, const char* argument) {
    const size_t size = sizeOf(given(to, argument), argument);
    std::memcpy(to, &value, std::min(size, sizeof(T)));
    to->size = size;
}

/// A text argument.
[[nodiscard]] std::string textOf(const char* text, const char* argument);
/// Into a buffer of the caller's (ts_scene_warning).
void giveText(std::string_view text, char* buffer, size_t capacity, size_t* needed);

} // namespace touchstone::api

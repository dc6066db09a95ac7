#pragma once
// Handles of the C interface: numbers that are never dereferenced and never given out again.

#include "touchstone/touchstone.h"

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

namespace touchstone::api {

/// What a handle names.
class Object {
  public:
    Object() = default;
    virtual ~Object() = default;
    Object(const Object&) = delete;
    Object& operator=(const Object&) = delete;
    /// Its handle was closed; a thread may still use it.
    virtual void closed() {}
};

/// A refused call: becomes its status and its message.
class Refused : public std::runtime_error {
  public:
    Refused(ts_status status, const std::string& message) : std::runtime_error(message), status_(status) {}
    [[nodiscard]] ts_status status() const { return status_; }

  private:
    ts_status status_;
};
[[noreturn]] void refuseArgument(const std::string& argument, const std::string& problem);

/// There are `count` of what the argument numbers.
inline void requireBelow(uint64_t index, size_t count, const char* argument) {
    if (index >= count)
        refuseArgument(argument, std::to_string(index) + ", and there are " + std::to_string(count));
}

/// Any thread. Zero is no handle.
[[nodiscard]] uintptr_t newHandle(std::shared_ptr<Object> object);
/// Null where the handle names nothing.
[[nodiscard]] std::shared_ptr<Object> objectOf(uintptr_t handle);
/// Forgets the handle and returns what it named.
[[nodiscard]] std::shared_ptr<Object> removeHandle(uintptr_t handle);

template <class Handle>
[[nodiscard]] uintptr_t numberOf(Handle* handle) {
    return reinterpret_cast<uintptr_t>(handle);
}
/// A new handle for `object` in `out`.
template <class Handle>
void give(std::shared_ptr<Object> object, Handle** out) {
    *out = reinterpret_cast<Handle*>(newHandle(std::move(object)));
}
/// Throws Refused (TS_CLOSED) where `handle` names no T; `argument` is its name in the call.
template <class T, class Handle>
[[nodiscard]] std::shared_ptr<T> take(Handle* handle, const char* argument) {
    std::shared_ptr<T> object = std::dynamic_pointer_cast<T>(objectOf(numberOf(handle)));
    if (object == nullptr)
        throw Refused(TS_CLOSED, std::string(argument) + ": this handle was closed, or names no such object");
    return object;
}
template <class T, class Handle>
void close(Handle* handle, const char* argument) {
    if (handle == nullptr)
        return;
    (void)take<T>(handle, argument);
    if (const std::shared_ptr<Object> object = removeHandle(numberOf(handle)))
        object->closed();
}

} // namespace touchstone::api

#include "api/c/calls.h"

#include "engine/core/error.h"
#include "engine/core/progress.h"

#include <new>

namespace touchstone::api {

namespace {

// Small: the library's thread-local variables lie in the static block, of which a program that loads it while
// it runs (Python) has some hundred bytes left.
thread_local std::string lastError;

ts_status failed(ts_status status, const char* message) noexcept {
    remember(message);
    return status;
}

} // namespace

void remember(const char* message) noexcept {
    try {
        lastError = message;
    } catch (const std::bad_alloc&) {
        lastError = "no memory"; // needs none: it is short
    }
}

ts_status statusOfException() noexcept {
    try {
        throw;
    } catch (const Refused& refused) {
        return failed(refused.status(), refused.what());
    } catch (const Cancelled& cancelled) {
        return failed(TS_CANCELLED, cancelled.what());
    } catch (const Error& error) {
        return failed(TS_INPUT, error.what());
    } catch (const std::bad_alloc&) {
        return failed(TS_MEMORY, "there is not enough memory");
    } catch (const std::length_error&) {
        return failed(TS_MEMORY, "more than memory can hold");
    } catch (const std::exception& error) {
        return failed(TS_INTERNAL, error.what());
    } catch (...) {
        return failed(TS_INTERNAL, "an unknown exception");
    }
}

std::string textOf(const char* text, const char* argument) {
    return &given(text, argument);
}

void giveText(std::string_view text, char* buffer, size_t capacity, size_t* needed) {
    if (buffer == nullptr && capacity > 0)
        refuseArgument("text", "is null, and its capacity is not 0");
    if (capacity > 0) {
        const size_t length = std::min(text.size(), capacity - 1);
        std::memcpy(buffer, text.data(), length);
        buffer[length] = '\0';
    }
    if (needed != nullptr)
        *needed = text.size() + 1;
}

} // namespace touchstone::api

extern "C" {

const char* ts_status_name(ts_status status) {
    switch (status) {
    case TS_OK:
        return "TS_OK";
    case TS_ARGUMENT:
        return "TS_ARGUMENT";
    case TS_CLOSED:
        return "TS_CLOSED";
    case TS_INPUT:
        return "TS_INPUT";
    case TS_STATE:
        return "TS_STATE";
    case TS_CANCELLED:
        return "TS_CANCELLED";
    case TS_MEMORY:
        return "TS_MEMORY";
    case TS_INTERNAL:
        return "TS_INTERNAL";
    }
    return "unknown status";
}

const char* ts_version(void) {
    return TOUCHSTONE_VERSION;
}

const char* ts_last_error(void) {
    return touchstone::api::lastError.c_str();
}

} // extern "C"

#pragma once
// Checks beyond the schema: relations between objects, each checked once before anything is read.

#include "engine/import/file/import_context.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>

namespace touchstone {

/// Checks required extensions, that the nodes form a forest without loops, and that buffer views and
/// accessors stay within their bounds. Throws Error; warns about tolerable flaws, and removes strides of 0
/// and children listed twice from `gltf`. Needs checkSchema first. Does not read the bytes.
void validateGltf(ImportContext& context, nlohmann::json& gltf);

/// Bytes of one component (5120 ... 5126), 0 if there is no such type.
[[nodiscard]] uint64_t componentBytes(int componentType);

/// Components of "SCALAR" ... "MAT4", 0 if there is no such type.
[[nodiscard]] int componentCount(const std::string& type);

/// Bytes of one accessor element in a buffer. Matrix columns start on multiples of four; the last one needs
/// no padding after it, so `bytes` may be less than the distance to the next element.
struct ElementSize {
    uint64_t bytes = 0, step = 0;
};
[[nodiscard]] ElementSize elementSize(const std::string& type, int componentType);

} // namespace touchstone

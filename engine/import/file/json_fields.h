#pragma once
// Fields of extensions, which the schema check does not cover: types and ranges are checked where they are
// read.

#include "engine/import/file/import_context.h"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>

namespace touchstone {

/// The extension `name` of `object`, or null. Fails if it exists and is not an object.
[[nodiscard]] const nlohmann::json* extensionOf(const ImportContext& context, const nlohmann::json& object,
                                                const char* name, const std::string& place);

/// A number in [low, high] that a float can hold; empty if absent.
[[nodiscard]] std::optional<float> numberField(const ImportContext& context, const nlohmann::json& object,
                                               const char* name, const std::string& place, double low,
                                               double high);

/// An integer in [0, size); empty if absent. `what` names the array for the message.
[[nodiscard]] std::optional<int> indexField(const ImportContext& context, const nlohmann::json& object,
                                            const char* name, const std::string& place, size_t size,
                                            const char* what);

[[nodiscard]] std::optional<std::string> textField(const ImportContext& context, const nlohmann::json& object,
                                                   const char* name, const std::string& place);

/// Two numbers; empty if absent.
[[nodiscard]] std::optional<glm::vec2> pairField(const ImportContext& context, const nlohmann::json& object,
                                                 const char* name, const std::string& place);

} // namespace touchstone

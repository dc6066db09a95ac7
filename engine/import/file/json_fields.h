#pragma once
// Fields of extensions, which no schema has checked: each is typed and ranged where it is read.

#include "engine/import/file/import_context.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>

namespace touchstone {

/// The extension `name` of `object`, or null. Fails if it is there and not an object.
[[nodiscard]] const nlohmann::json* extensionOf(const ImportContext& context, const nlohmann::json& object,
                                                const char* name, const std::string& place);

/// A number in [low, high] that a float can hold; nothing if absent.
[[nodiscard]] std::optional<float> numberField(const ImportContext& context, const nlohmann::json& object,
                                               const char* name, const std::string& place, double low,
                                               double high);

/// An integer in [0, size); nothing if absent. `what` names the array for the message.
[[nodiscard]] std::optional<int> indexField(const ImportContext& context, const nlohmann::json& object,
                                            const char* name, const std::string& place, size_t size,
                                            const char* what);

[[nodiscard]] std::optional<std::string> textField(const ImportContext& context, const nlohmann::json& object,
                                                   const char* name, const std::string& place);

/// Two numbers; nothing if absent.
[[nodiscard]] std::optional<glm::vec2> pairField(const ImportContext& context, const nlohmann::json& object,
                                                 const char* name, const std::string& place);

} // namespace touchstone

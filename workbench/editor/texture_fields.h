#pragma once
// Fields of `touchstone edit` that are no plain numbers of a material: its program's persistent texture, and
// where texture coordinates come from.

#include "engine/scene/material.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace touchstone {

/// "shader.persistentTexture" and its members.
[[nodiscard]] bool isPersistentField(std::string_view name);
/// WIDTH,HEIGHT for the texture itself; a number for a member. Returns the problem with its remedy; empty:
/// none. Another size takes out the values that the file has of it.
[[nodiscard]] std::string setPersistentField(HapticStatement& statement, std::string_view name,
                                             std::string_view text);
/// False: there is no such member.
bool resetPersistentField(HapticStatement& statement, std::string_view name);

/// "textureMapping" and its members.
[[nodiscard]] bool isMappingField(std::string_view name);
/// The `textureMapping` of a material in the file; null: none.
[[nodiscard]] nlohmann::json mappingInFile(const std::filesystem::path& file, size_t material);
/// `mapping` with the field: a surface (or none) for "textureMapping", else a member. Throws Error where no
/// file could state that.
[[nodiscard]] nlohmann::json withMappingField(nlohmann::json mapping, std::string_view name,
                                              std::string_view text);

/// Lines for --help.
[[nodiscard]] std::string textureFieldHelp();

} // namespace touchstone

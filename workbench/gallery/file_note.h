#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

/// The description in a glTF file's `asset.extras.description`: one line; empty where there is none, the file
/// is invalid or has more than 16 MiB of JSON. Reads only the JSON. Any thread.
[[nodiscard]] std::string fileNote(const std::filesystem::path& model);
/// For each of them.
[[nodiscard]] std::vector<std::string> notesOf(std::span<const std::filesystem::path> models);

} // namespace touchstone

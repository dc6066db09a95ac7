#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

/// What a glTF file says about itself in `asset.extras.description`: a line; empty where it says nothing, is
/// broken or has more than 16 MiB of JSON. Reads no more than the JSON. Any thread.
[[nodiscard]] std::string fileNote(const std::filesystem::path& model);
/// Of each.
[[nodiscard]] std::vector<std::string> notesOf(std::span<const std::filesystem::path> models);

} // namespace touchstone

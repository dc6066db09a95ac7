#pragma once

#include <filesystem>
#include <string>

namespace touchstone {

/// Throws Error, as `shownAs`, unless the path leads to a file: one that exists and is no folder, pipe or
/// device, where a reader would wait or read for ever. `remedy`: for what is there, but no file. Any thread.
void requireFile(const std::filesystem::path& path, const std::string& shownAs, const std::string& remedy);

} // namespace touchstone

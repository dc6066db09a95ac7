#pragma once
// What the list of recordings does to files.

#include <filesystem>
#include <string_view>

namespace touchstone {

/// Renames a recording within its folder; `name` without the ending, which is kept. Returns its new path.
/// Throws Error and changes nothing where the name is empty, hidden, reserved for the flight recorder
/// ("live-…"), longer than the file system takes, or has a slash or a control character; where it is taken;
/// where the file is gone or the folder read-only.
std::filesystem::path renameRecording(const std::filesystem::path& file, std::string_view name);

/// Throws Error where the file is gone or cannot be deleted.
void deleteRecording(const std::filesystem::path& file);

} // namespace touchstone

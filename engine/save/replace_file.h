#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace touchstone {

/// Puts `bytes` in the place of `target` as a whole or not at all: written beside it under another name, made
/// sure to be on the disk, renamed. Permissions of a file that was there are kept, a symbolic link is
/// followed. Any thread but the servo; throws Error that names the target.
void replaceFile(const std::filesystem::path& target, std::span<const uint8_t> bytes);

} // namespace touchstone

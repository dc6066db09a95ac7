#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace touchstone {

/// Replaces `target` by `bytes` as a whole or not at all: written beside it under another name, synchronised
/// to the disk, renamed. An existing file's permissions are kept, a symbolic link is followed. Any thread but
/// the servo; throws Error that names the target.
void replaceFile(const std::filesystem::path& target, std::span<const uint8_t> bytes);

} // namespace touchstone

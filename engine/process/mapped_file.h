#pragma once

#include "engine/process/process_answer.h"

#include <cstdint>
#include <span>

namespace touchstone {

/// The bytes of an open file, read-only, for as long as this lives; none of an empty file, and where the
/// system refuses. A file that somebody shortens meanwhile ends the program at the next reading: only for
/// files of our own.
class MappedFile {
  public:
    MappedFile() = default;
    explicit MappedFile(const FileDescriptor& file);
    ~MappedFile();
    MappedFile(MappedFile&& other) noexcept;
    MappedFile& operator=(MappedFile&& other) noexcept;
    [[nodiscard]] std::span<const uint8_t> bytes() const { return bytes_; }

  private:
    std::span<const uint8_t> bytes_;
};

} // namespace touchstone

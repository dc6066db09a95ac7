#pragma once

#include "engine/import/volume_reader/raw_volume.h"

#include <cstdint>
#include <span>

namespace touchstone {

/// Refuses sizes that are too small to be felt, and volumes whose values take more than `most` bytes in the
/// answer, with both sizes. Throws BadVolume.
void checkVolumeSize(const RawVolume& volume, uint64_t most);

/// Writes head and values to standard output (engine/import/volume_file/flat_volume_format.h), a row at a
/// time. `data`: the data of a file of their own, or what follows the header. Axes of the wrong hand are
/// made right by reversing the rows. Throws BadVolume.
void writeVolume(RawVolume volume, std::span<const uint8_t> data);

/// The first `most` bytes of what a gzip or zlib stream holds. Throws BadVolume where it is none.
[[nodiscard]] std::vector<uint8_t> inflatedStart(std::span<const uint8_t> deflated, size_t most);

/// OpenVDB's own files: the first grid of numbers. Throws BadVolume; before the sandbox call
/// prepareVdb. `most` as above.
void prepareVdb();
void writeVdb(std::span<const uint8_t> file, uint64_t most);

} // namespace touchstone

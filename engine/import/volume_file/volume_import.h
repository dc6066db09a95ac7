#pragma once
// Volumes, read by a process of its own (engine/import/volume_reader), whose answer is checked again: a file
// that crashes, hangs or fills what reads it ends that process, and is an Error here.

#include "engine/import/file/import_context.h"
#include "engine/import/volume_file/volume_format.h"
#include "engine/process/limited_process.h"
#include "engine/volume/volume.h"

#include <cstdint>
#include <filesystem>
#include <memory>

namespace touchstone {

/// Bytes of a volume's values in memory.
inline constexpr uint64_t kMaxVolumeBytes = uint64_t{1} << 30;

/// The program that reads volumes. It gets one file at a time and no access to any other, nor to a network.
struct VolumeReader {
    std::filesystem::path program;
    ProcessLimits limits;
    uint64_t mostBytes = kMaxVolumeBytes;
};

/// touchstone_volume_reader, or touchstone_vdb_reader for OpenVDB's files, beside the running program, for a
/// file of so many bytes: at most 10 s of a processor and 1 s for each 4 MB, ten times as long of the clock,
/// 4 GiB.
[[nodiscard]] VolumeReader installedVolumeReader(VolumeFormat format, uint64_t bytes);

/// Values in a file of their own are read where it lies in the folder of `path` or below. Throws Error, and
/// Cancelled, of which it looks every 20 ms or more often. Any thread.
[[nodiscard]] std::shared_ptr<const Volume> readVolume(const ImportContext& context,
                                                       const std::filesystem::path& path, VolumeFormat format,
                                                       const VolumeReader& reader);

} // namespace touchstone

#pragma once
// The form in which touchstone_volume_reader and touchstone_vdb_reader, child processes, answer: one
// FlatVolumeHead, then the values, the first axis fastest, in this machine's byte order. Shared by both
// processes.

#include "engine/volume/volume_type.h"

#include <cstdint>

namespace touchstone {

inline constexpr uint32_t kFlatVolumeMagic = 0x31465654; // "TVF1"

/// What a file leaves open.
enum FlatVolumeNote : uint32_t { kNoUnit = 1, kNoOrientation = 2, kSeveralGrids = 4, kAllVolumeNotes = 7 };

struct FlatVolumeHead {
    uint32_t magic = kFlatVolumeMagic;
    uint32_t type = 0;      ///< VolumeType
    uint32_t size[3] = {};  ///< voxels along each axis
    uint32_t notes = 0;     ///< FlatVolumeNotes
    double axes[3][3] = {}; ///< m, scene frame: from a voxel to the next along each axis
    double origin[3] = {};  ///< m, scene frame: the centre of the first voxel
    double scale = 1.0;     ///< a value means scale * stored + offset
    double offset = 0.0;
    double iso = 0.0;       ///< what the file states; not a number where it states none
    char fileType[16] = {}; ///< of the values in the file, ends with zero
    bool operator==(const FlatVolumeHead&) const = default;
};

/// Exit status of the reader where the values are in another file; its answer is that file's name.
inline constexpr int kDetachedData = 3;

/// Voxels on an axis.
inline constexpr uint32_t kMostVolumeAxis = 1u << 16;
/// Longest header of text that is read, bytes.
inline constexpr uint32_t kMostVolumeHeader = 1u << 16;

} // namespace touchstone

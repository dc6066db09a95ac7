#pragma once
// The distance field of a surface in a volume. Not for the servo thread.

#include "engine/core/progress.h"
#include "engine/math/similarity.h"
#include "engine/volume/volume.h"
#include "haptics/shape/field/field_grid.h"

#include <cstdint>
#include <memory>

namespace touchstone {

/// A field and where it lies.
struct VolumeField {
    std::shared_ptr<const FieldGrid> grid;
    Similarity sceneFromObject; ///< the object's unit is the longest side of the volume's box
    double coarser = 1.0;       ///< voxel of the field over the finest spacing of the volume
    double mostNodes = 0.0;     ///< that it might have
};

/// How far from the surface the field tells distances, m in the scene frame: inside at most kDeepestVoxels.
struct FieldReach {
    double inside = 0.0, outside = 0.0;
};

inline constexpr double kMostVolumeNodes = 1.5e8; ///< of 512^3 voxels and a margin
inline constexpr uint64_t kMostNearNodes = 40'000'000;
inline constexpr double kDeepestVoxels = 40.0;

/// Distances from the surface where the volume's values are `iso`, negative where they are at least that; the
/// volume's border closes it. Nodes are the volume's voxels where its axes are at right angles and equally
/// spaced; else it is interpolated at voxels of the finest spacing, at the volume's axes as far as these are
/// at right angles, and at larger ones where there would be more than kMostVolumeNodes or
/// FieldGrid::kMostOnAxis, or more than `mostNear` next to the surface, as in noise: then there are no more
/// than these (a thousand at least). Throws Error, naming `shownAs`, and Cancelled.
[[nodiscard]] VolumeField fieldOfVolume(const Volume& volume, double iso, const FieldReach& reach,
                                        const std::string& shownAs, const Progress& progress = {},
                                        uint64_t mostNear = kMostNearNodes);

} // namespace touchstone

#pragma once

#include "engine/core/progress.h"
#include "engine/volume/volume.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace touchstone {

/// Triangles of a surface, for the eye.
struct SurfaceMesh {
    std::vector<glm::vec3> positions, normals; ///< m, scene frame; unit, outwards
    std::vector<uint32_t> corners;             ///< 3 a triangle, counter-clockwise from outside
};

/// The surface where the values are `iso`, closed at the volume's border, by OpenVDB's dual contouring
/// (volumeToMesh). A volume of more than kMostDrawnVoxels is meshed from every second, third ... voxel: such
/// a mesh lies off by up to that many voxels where the surface is curved; the hand feels all of them. Throws
/// Error and Cancelled.
[[nodiscard]] SurfaceMesh meshOfVolume(const Volume& volume, double iso, const std::string& shownAs,
                                       const Progress& progress = {});

inline constexpr uint64_t kMostDrawnVoxels = uint64_t{1} << 26;

} // namespace touchstone

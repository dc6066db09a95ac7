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
    std::vector<glm::vec4> colors;             ///< linear, 0..1; empty: white
    std::vector<uint32_t> corners;             ///< 3 a triangle, counter-clockwise from outside
    int stride = 1;                            ///< voxels from a sample to the next; less on thin axes
};

inline constexpr uint64_t kMostDrawnVoxels = uint64_t{1} << 26;
/// Quadrilaterals: two triangles each, and up to four in a field's mesh (meshOfField).
inline constexpr uint64_t kMostSurfaceFaces = uint64_t{1} << 22;

/// The surface where the values are `iso` (highestOutside), closed at the volume's border, by OpenVDB's dual
/// contouring (volumeToMesh). A volume of more than kMostDrawnVoxels is meshed from every second, third ...
/// voxel, and so is a surface of more than `mostFaces` (noise has more faces than voxels: it would fill the
/// memory of the process that moves the hand): such a mesh lies off by up to that many voxels where the
/// surface is curved; the hand feels all of them. Throws Error, also where every fourth voxel gives too many
/// faces, and Cancelled.
[[nodiscard]] SurfaceMesh meshOfVolume(const Volume& volume, double iso, const std::string& shownAs,
                                       const Progress& progress = {}, uint64_t mostFaces = kMostSurfaceFaces);

} // namespace touchstone

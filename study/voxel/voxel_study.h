#pragma once
// What a distance field's voxel costs and buys: errors against closed forms and meshes, beside time, memory
// and the time to build it.

#include "study/result/result.h"
#include "study/voxel/voxel_shape.h"

#include <functional>
#include <string>
#include <vector>

namespace touchstone::study {

struct VoxelOptions {
    std::vector<int> across{64, 128, 256, 512}; ///< voxels on the diagonal of the shape's box
    bool meshes = true;                         ///< the meshes themselves, and fields built from them
    size_t errorTicks = 4000;                   ///< of the stroke, from the start of the descent
    int rounds = 30, ticksPerRound = 480;       ///< 0 rounds: no times
    /// Further meshes of the torus at 256 voxels, for the tick's independence of triangles.
    std::vector<size_t> torusTriangles{456, 1'000'000};
};

/// Every shape, source and method; `notes` tells what is left out. Fields are as deep as fieldDepths().
/// Calling thread; `progress` gets 0..1.
[[nodiscard]] std::vector<VoxelResult> studyVoxels(const VoxelOptions& options,
                                                   std::vector<std::string>& notes,
                                                   const std::function<void(double)>& progress);

/// One shape.
[[nodiscard]] std::vector<VoxelResult> studyVoxelsOf(const VoxelShape& shape, const VoxelOptions& options,
                                                     std::vector<std::string>& notes,
                                                     const std::function<void(double)>& progress);

/// p where `error` of two results behaves as voxel^p: of the coarsest and the finest of those of a source and
/// a method, of one shape. NaN where there are no two.
[[nodiscard]] double voxelOrder(const std::vector<VoxelResult>& results, const std::string& shape,
                                const std::string& source, const std::string& method,
                                double VoxelResult::*error);

} // namespace touchstone::study

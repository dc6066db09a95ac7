#include "haptics/shape/field/mesh_to_field.h"

#include "engine/core/checksum.h"
#include "engine/core/error.h"
#include "haptics/shape/field/node_distances.h"

#include <openvdb/version.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace touchstone {

namespace {

/// The object's bounds, and room about them for the field's outside and two voxels.
void roomFor(const HapticObject& mesh, double outside, double voxel, glm::dvec3& low, glm::dvec3& size) {
    low = glm::dvec3(INFINITY);
    glm::dvec3 high(-INFINITY);
    for (const uint32_t v : mesh.indices) {
        low = glm::min(low, glm::dvec3(mesh.vertices[v]));
        high = glm::max(high, glm::dvec3(mesh.vertices[v]));
    }
    const double margin = outside + 2.0 * voxel;
    low -= margin;
    size = high - low + margin;
}

FieldLayout layoutFor(const HapticObject& mesh, const FieldRequest& request) {
    if (!(request.voxel > 0.0) || !std::isfinite(request.voxel))
        throw Error(mesh.name, "", "the voxel size is no positive number", "give a voxelSize above 0");
    if (const double finest = finestVoxel(mesh, request.outside); request.voxel < finest)
        throw Error(mesh.name, "",
                    "a distance field with voxels of " + std::to_string(request.voxel) +
                        " of its size has more than " + std::to_string(kMostFieldCells) + " cells",
                    "make the voxels at least " + std::to_string(finest / request.voxel) + " times as large");
    FieldLayout layout{.voxel = request.voxel};
    glm::dvec3 size;
    roomFor(mesh, request.outside, request.voxel, layout.origin, size);
    layout.cells = glm::ivec3(glm::ceil(size / request.voxel));
    return layout;
}

/// The relief is whole up to here from the surface: over all places where it puts the surface, and two
/// voxels.
double wholeUpTo(const FieldRelief& relief, double voxel) {
    return relief.highest() + 2.0 * voxel;
}

/// Subtracts the relief from the nodes of a brick, in proportion to what reliefShare leaves of it.
void layRelief(const FieldLayout& layout, const FieldRequest& request, const glm::ivec3& first,
               std::span<float> nodes) {
    const double whole = wholeUpTo(request.relief, request.voxel);
    FieldRelief relief = request.relief;
    if (relief.noiseWavelength < layout.voxel)
        relief.noiseWavelength = 0.0; // no two nodes share a value
    size_t i = 0;
    for (int z = 0; z < FieldGrid::kNodes; ++z)
        for (int y = 0; y < FieldGrid::kNodes; ++y)
            for (int x = 0; x < FieldGrid::kNodes; ++x) {
                float& node = nodes[i++];
                const auto f = static_cast<double>(node);
                const double share = reliefShare(f, whole, f < 0.0 ? request.inside : request.outside);
                if (!(share > 0.0))
                    continue;
                const glm::ivec3 at = first + glm::ivec3(x, y, z);
                const glm::dvec3 place = layout.origin + layout.voxel * glm::dvec3(at);
                node = static_cast<float>(f - share * reliefAt(relief, place, at));
            }
}

/// `closed`: negative inside; else a shell.
std::shared_ptr<const FieldGrid> gridOf(const HapticObject& mesh, const FieldLayout& layout,
                                        const FieldRequest& request, bool closed, const Progress& progress) {
    const NodeDistances distances(mesh, layout, {request.inside, request.outside}, closed,
                                  progress.part(0.0, 0.7));
    progress.step(0.7, kBuildingField);
    const auto layers = static_cast<double>((layout.cells.z + FieldGrid::kBrick - 1) / FieldGrid::kBrick);
    return std::make_shared<const FieldGrid>(
        layout, request.inside, request.outside, [&](const glm::ivec3& first, std::span<float> nodes) {
            if (first.x == 0 && first.y == 0)
                progress.step(0.7 + 0.3 * (first.z / FieldGrid::kBrick) / layers, kBuildingField);
            distances.copyBrick(first, nodes);
            if (!request.relief.empty())
                layRelief(layout, request, first, nodes);
        });
}

} // namespace

double reachOf(const FieldRelief& relief, double voxel) {
    return relief.empty() ? 0.0 : 2.0 * wholeUpTo(relief, voxel);
}

double finestVoxel(const HapticObject& mesh, double outside) {
    glm::dvec3 low, size;
    roomFor(mesh, outside, 0.0, low, size);
    // The margin of two voxels and the rounding up add at most five cells to each axis.
    const auto cells = [&](double voxel) {
        const glm::dvec3 n = size / voxel + 5.0;
        return n.x * n.y * n.z;
    };
    double voxel = std::cbrt(size.x * size.y * size.z / static_cast<double>(kMostFieldCells));
    while (cells(voxel) > static_cast<double>(kMostFieldCells))
        voxel *= 1.01;
    return voxel;
}

std::shared_ptr<const FieldGrid> fieldOfMesh(const HapticObject& mesh, const FieldRequest& asked,
                                             const Progress& progress) {
    progress.stopIfCancelled();
    // Clamped values must not enter a cell through which the surface passes.
    FieldRequest request = asked;
    const double least = std::max(2.0 * asked.voxel, reachOf(asked.relief, asked.voxel));
    request.inside = std::max(asked.inside, least);
    request.outside = std::max(asked.outside, least);
    const FieldLayout layout = layoutFor(mesh, request);
    if (mesh.closed) {
        const auto solid = gridOf(mesh, layout, request, true, progress.part(0.0, 0.6));
        if (solid->low().x <= solid->high().x)
            return solid;
    }
    return gridOf(mesh, layout, request, false, progress.part(0.6, 1.0));
}

namespace {

/// Of all that the field depends on; kBuilder: of this file and of node_distances.
uint64_t keyOf(const HapticObject& mesh, const FieldRequest& request) {
    constexpr int kBuilder = 2;
    Hash64 hash;
    hash.add(kBuilder);
    hash.add(FieldGrid::kBrick);
    hash.add(openvdb::OPENVDB_LIBRARY_VERSION);
    hash.add(mesh.closed);
    for (const double number : {request.voxel, request.inside, request.outside})
        hash.add(number);
    if (const FieldRelief& relief = request.relief; !relief.empty()) {
        for (const double number :
             {relief.noise, relief.noiseWavelength, relief.lattice, relief.latticeWavelength})
            hash.add(number);
        hash.add(relief.seed);
    }
    hash.add(mesh.vertices.size());
    for (const glm::vec3& v : mesh.vertices)
        for (int axis = 0; axis < 3; ++axis)
            hash.add(v[axis]);
    hash.add(mesh.indices.size());
    for (const uint32_t index : mesh.indices)
        hash.add(index);
    return hash.value();
}

} // namespace

std::shared_ptr<const FieldGrid> fieldOfMesh(const HapticObject& mesh, const FieldRequest& request,
                                             const FieldCache& cache, const Progress& progress) {
    const uint64_t key = keyOf(mesh, request);
    if (auto kept = cache.find(key))
        return kept;
    auto built = fieldOfMesh(mesh, request, progress);
    cache.keep(key, *built);
    return built;
}

} // namespace touchstone

#include "haptics/shape/field/mesh_to_field.h"

#include "engine/core/checksum.h"
#include "engine/core/error.h"

#include <openvdb/tools/MeshToVolume.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace touchstone {

namespace {

/// OpenVDB asks it now and then whether to stop. As its base it is given to what OpenVDB's library holds
/// compiled.
class Interrupter final : public openvdb::util::NullInterrupter {
  public:
    explicit Interrupter(const Progress& progress) : progress_(progress) {}
    bool wasInterrupted(int = -1) override { return progress_.cancelled(); }

  private:
    const Progress& progress_;
};

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

using Soup = openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I>;

/// `solid`: negative inside; else a shell.
std::shared_ptr<const FieldGrid> gridOf(const Soup& soup, const FieldLayout& layout,
                                        const FieldRequest& request, bool solid, const Progress& progress) {
    constexpr const char* kBuilding = "building the distance field";
    const double shell = solid ? 0.0 : layout.voxel; // half of its thickness
    const auto band = [&](double distance) {
        return static_cast<float>((distance + shell) / layout.voxel + 1.0);
    };
    const auto transform = openvdb::math::Transform::createLinearTransform(layout.voxel);
    Interrupter interrupter(progress);
    openvdb::FloatGrid::Ptr distances;
    {
        constexpr double kTimePerCell = 4e-9; // s
        const EstimatedProgress estimate(progress.part(0.0, 0.7), kBuilding,
                                         0.1 +
                                             kTimePerCell * layout.cells.x * layout.cells.y * layout.cells.z);
        distances = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
            static_cast<openvdb::util::NullInterrupter&>(interrupter), soup, *transform,
            band(request.outside), band(solid ? request.inside : 0.0),
            solid ? openvdb::tools::DISABLE_RENORMALIZATION : openvdb::tools::UNSIGNED_DISTANCE_FIELD);
    }
    progress.step(0.7, kBuilding);
    openvdb::FloatGrid::ConstAccessor read = distances->getConstAccessor();
    const auto layers = static_cast<double>((layout.cells.z + FieldGrid::kBrick - 1) / FieldGrid::kBrick);
    return std::make_shared<const FieldGrid>(
        layout, request.inside, request.outside, [&](const glm::ivec3& first, std::span<float> nodes) {
            if (first.x == 0 && first.y == 0)
                progress.step(0.7 + 0.3 * (first.z / FieldGrid::kBrick) / layers, kBuilding);
            size_t i = 0;
            for (int z = 0; z < FieldGrid::kNodes; ++z)
                for (int y = 0; y < FieldGrid::kNodes; ++y)
                    for (int x = 0; x < FieldGrid::kNodes; ++x)
                        nodes[i++] = read.getValue({first.x + x, first.y + y, first.z + z}) -
                                     static_cast<float>(shell);
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
    std::vector<openvdb::Vec3s> points;
    points.reserve(mesh.vertices.size());
    for (const glm::vec3& v : mesh.vertices) {
        const glm::dvec3 index = (glm::dvec3(v) - layout.origin) / layout.voxel;
        points.emplace_back(index.x, index.y, index.z);
    }
    std::vector<openvdb::Vec3I> triangles;
    triangles.reserve(mesh.triangleCount());
    for (size_t t = 0; t < mesh.triangleCount(); ++t)
        triangles.emplace_back(mesh.indices[3 * t], mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]);
    const Soup soup(points, triangles);
    if (mesh.closed) {
        const auto solid = gridOf(soup, layout, request, true, progress.part(0.0, 0.6));
        if (solid->low().x <= solid->high().x)
            return solid;
    }
    return gridOf(soup, layout, request, false, progress.part(0.6, 1.0));
}

namespace {

/// Of all that the field depends on; kBuilder: of this file.
uint64_t keyOf(const HapticObject& mesh, const FieldRequest& request) {
    constexpr int kBuilder = 1;
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

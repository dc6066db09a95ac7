#include "haptics/shape/field/mesh_to_field.h"

#include "engine/core/error.h"

#include <openvdb/tools/MeshToVolume.h>

#include <cmath>
#include <string>

namespace touchstone {

namespace {

/// OpenVDB asks it now and then whether to stop.
struct Interrupter {
    const Progress& progress;
    void start(const char* = nullptr) {}
    void end() {}
    bool wasInterrupted(int = -1) { return progress.cancelled(); }
};

FieldLayout layoutFor(const HapticObject& mesh, const FieldRequest& request) {
    if (!(request.voxel > 0.0) || !std::isfinite(request.voxel))
        throw Error(mesh.name, "", "the voxel size is no positive number", "give a voxelSize above 0");
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (const uint32_t v : mesh.indices) {
        low = glm::min(low, glm::dvec3(mesh.vertices[v]));
        high = glm::max(high, glm::dvec3(mesh.vertices[v]));
    }
    const double margin = request.outside + 2.0 * request.voxel;
    const glm::dvec3 size = high - low + 2.0 * margin;
    const auto cellsAt = [&](double voxel) {
        return std::ceil(size.x / voxel) * std::ceil(size.y / voxel) * std::ceil(size.z / voxel);
    };
    if (const double cells = cellsAt(request.voxel); !(cells <= static_cast<double>(kMostFieldCells))) {
        const double fits =
            std::cbrt(size.x * size.y * size.z / (0.97 * static_cast<double>(kMostFieldCells)));
        throw Error(mesh.name, "",
                    "a distance field with voxels of " + std::to_string(request.voxel) + " of its size has " +
                        std::to_string(cells) + " cells; " + std::to_string(kMostFieldCells) + " are allowed",
                    "make the voxels at least " + std::to_string(fits / request.voxel) + " times as large");
    }
    return {
        .origin = low - margin, .voxel = request.voxel, .cells = glm::ivec3(glm::ceil(size / request.voxel))};
}

} // namespace

std::shared_ptr<const FieldGrid> fieldOfMesh(const HapticObject& mesh, const FieldRequest& request,
                                             const Progress& progress) {
    progress.step(0.0, "building the distance field");
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
    const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> soup(points, triangles);
    const double shell = mesh.closed ? 0.0 : layout.voxel; // half of its thickness
    const auto band = [&](double distance) {
        return static_cast<float>((distance + shell) / layout.voxel + 1.0);
    };
    const auto transform = openvdb::math::Transform::createLinearTransform(layout.voxel);
    Interrupter interrupter{progress};
    openvdb::FloatGrid::Ptr distances;
    {
        constexpr double kTimePerCell = 4e-9; // s
        const EstimatedProgress estimate(progress.part(0.0, 0.7), "building the distance field",
                                         0.1 +
                                             kTimePerCell * layout.cells.x * layout.cells.y * layout.cells.z);
        distances = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
            interrupter, soup, *transform, band(request.outside), band(mesh.closed ? request.inside : 0.0),
            mesh.closed ? 0 : openvdb::tools::UNSIGNED_DISTANCE_FIELD);
    }
    progress.step(0.7, "packing the distance field");
    openvdb::FloatGrid::ConstAccessor read = distances->getConstAccessor();
    const auto bricks = static_cast<double>((layout.cells.z + FieldGrid::kBrick - 1) / FieldGrid::kBrick);
    return std::make_shared<const FieldGrid>(
        layout, request.inside, request.outside, [&](const glm::ivec3& first, std::span<float> nodes) {
            if (first.x == 0 && first.y == 0)
                progress.step(0.7 + 0.3 * (first.z / FieldGrid::kBrick) / bricks,
                              "packing the distance field");
            size_t i = 0;
            for (int z = 0; z < FieldGrid::kNodes; ++z)
                for (int y = 0; y < FieldGrid::kNodes; ++y)
                    for (int x = 0; x < FieldGrid::kNodes; ++x)
                        nodes[i++] = read.getValue({first.x + x, first.y + y, first.z + z}) -
                                     static_cast<float>(shell);
        });
}

} // namespace touchstone

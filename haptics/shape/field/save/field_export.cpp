#include "haptics/shape/field/save/field_export.h"

#include "engine/core/error.h"
#include "haptics/shape/field/field_shape.h"
#include "haptics/shape/field/save/field_faces.h"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/task_arena.h>

#include <array>
#include <sstream>
#include <utility>
#include <vector>

namespace touchstone {

namespace {

/// Grid coordinates as index space; values times `scale`. Flat bricks are tiles.
openvdb::FloatGrid::Ptr gridOfField(const FieldGrid& field, double scale) {
    const auto outside = static_cast<float>(scale * field.outside());
    const auto inside = static_cast<float>(-scale * field.inside());
    auto grid = openvdb::FloatGrid::create(outside);
    openvdb::FloatGrid::Accessor accessor = grid->getAccessor();
    std::array<float, kNodesInBrick> nodes{};
    const glm::ivec3 bricks = field.bricks();
    for (int z = 0; z < bricks.z; ++z)
        for (int y = 0; y < bricks.y; ++y)
            for (int x = 0; x < bricks.x; ++x) {
                const glm::ivec3 first = kBrickCells * glm::ivec3(x, y, z);
                const openvdb::Coord at(first.x, first.y, first.z);
                if (const float flat = field.flatBrick(first); flat == flat) {
                    if (flat < 0.0f)
                        accessor.addTile(1, at, static_cast<float>(scale * static_cast<double>(flat)), false);
                    continue;
                }
                field.copyBrick({x, y, z}, nodes);
                auto* const leaf = accessor.touchLeaf(at);
                for (int k = 0; k < kBrickCells; ++k)
                    for (int j = 0; j < kBrickCells; ++j)
                        for (int i = 0; i < kBrickCells; ++i) {
                            const auto value =
                                static_cast<float>(scale * static_cast<double>(nodes[brickNode({i, j, k})]));
                            const openvdb::Coord node(i, j, k);
                            if (value > inside && value < outside)
                                leaf->setValueOn(node, value);
                            else
                                leaf->setValueOff(node, value);
                        }
            }
    return grid;
}

} // namespace

SurfaceMesh meshOfField(const std::shared_ptr<const FieldGrid>& field, const Similarity& sceneFromObject,
                        const FieldColors* colors) {
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles; // none without adaptivity
    std::vector<openvdb::Vec4I> quads;
    tbb::task_arena(2).execute([&] {
        openvdb::initialize();
        openvdb::tools::volumeToMesh(*gridOfField(*field, 1.0), points, triangles, quads, 0.0, 0.0);
    });
    if (quads.size() > kMostSurfaceFaces) // triangles: two each, some four
        throw Error("sculpting", "",
                    "the surface has " + std::to_string(quads.size()) + " faces, of which " +
                        std::to_string(kMostSurfaceFaces) + " fit",
                    "use larger voxels");
    SurfaceMesh mesh;
    const FieldLayout& layout = field->layout();
    const FieldShape shape(field);
    FieldFaces faces = facesOf(*field, points, quads);
    mesh.positions.reserve(faces.vertices.size());
    mesh.normals.reserve(faces.vertices.size());
    for (const glm::dvec3& vertex : faces.vertices) {
        const glm::dvec3 place = layout.origin + layout.voxel * vertex;
        const glm::dvec3 normal = sceneFromObject.direction(shape.shadingNormal(0, place));
        mesh.positions.emplace_back(sceneFromObject.point(place));
        if (colors != nullptr)
            mesh.colors.emplace_back(colors->at(place), 1.0f);
        mesh.normals.emplace_back(glm::dot(normal, normal) > 0.0 ? normal : glm::dvec3(0.0, 1.0, 0.0));
    }
    mesh.corners = std::move(faces.corners);
    return mesh;
}

std::string vdbOfField(const FieldGrid& field, const Similarity& sceneFromObject, const std::string& name) {
    openvdb::initialize();
    const openvdb::FloatGrid::Ptr grid = gridOfField(field, sceneFromObject.scale);
    const FieldLayout& layout = field.layout();
    // OpenVDB multiplies row vectors: an axis is a row.
    openvdb::Mat4d worldFromIndex = openvdb::Mat4d::identity();
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 unit(0.0);
        unit[axis] = layout.voxel;
        const glm::dvec3 step = sceneFromObject.vector(unit);
        for (int k = 0; k < 3; ++k)
            worldFromIndex(axis, k) = step[k];
    }
    const glm::dvec3 origin = sceneFromObject.point(layout.origin);
    for (int k = 0; k < 3; ++k)
        worldFromIndex(3, k) = origin[k];
    grid->setTransform(openvdb::math::Transform::createLinearTransform(worldFromIndex));
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    grid->setName(name);
    std::ostringstream bytes(std::ios::binary);
    openvdb::io::Stream(bytes).write(openvdb::GridCPtrVec{grid});
    return std::move(bytes).str();
}

} // namespace touchstone

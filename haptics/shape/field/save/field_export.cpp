#include "haptics/shape/field/save/field_export.h"

#include "engine/core/error.h"
#include "engine/grid/sparse_grid.h"
#include "haptics/shape/field/field_shape.h"
#include "haptics/shape/field/save/field_faces.h"

#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace touchstone {

namespace {

/// Grid coordinates as index space; values times `scale`. Flat bricks are tiles.
std::unique_ptr<SparseGrid> gridOfField(const FieldGrid& field, double scale) {
    const auto outside = static_cast<float>(scale * field.outside());
    const auto inside = static_cast<float>(-scale * field.inside());
    static_assert(kBrickCells == SparseGrid::kLeaf);
    auto grid = gridLibrary().create(outside, 2);
    std::array<float, static_cast<size_t>(kBrickCells * kBrickCells * kBrickCells)> leaf{};
    std::array<float, kNodesInBrick> nodes{};
    const glm::ivec3 bricks = field.bricks();
    for (int z = 0; z < bricks.z; ++z)
        for (int y = 0; y < bricks.y; ++y)
            for (int x = 0; x < bricks.x; ++x) {
                const glm::ivec3 first = kBrickCells * glm::ivec3(x, y, z);
                if (const float flat = field.flatBrick(first); flat == flat) {
                    if (flat < 0.0f)
                        grid->fillLeaf(first, static_cast<float>(scale * static_cast<double>(flat)));
                    continue;
                }
                field.copyBrick({x, y, z}, nodes);
                size_t node = 0;
                for (int k = 0; k < kBrickCells; ++k)
                    for (int j = 0; j < kBrickCells; ++j)
                        for (int i = 0; i < kBrickCells; ++i)
                            leaf[node++] =
                                static_cast<float>(scale * static_cast<double>(nodes[brickNode({i, j, k})]));
                grid->setLeaf(first, leaf, inside, outside);
            }
    return grid;
}

} // namespace

SurfaceMesh meshOfField(const std::shared_ptr<const FieldGrid>& field, const Similarity& sceneFromObject,
                        const FieldColors* colors) {
    const GridFaces zero = gridOfField(*field, 1.0)->zero();
    if (zero.quads.size() > kMostSurfaceFaces) // triangles: two each, some four
        throw Error("sculpting", "",
                    "the surface has " + std::to_string(zero.quads.size()) + " faces, of which " +
                        std::to_string(kMostSurfaceFaces) + " fit",
                    "use larger voxels");
    SurfaceMesh mesh;
    const FieldLayout& layout = field->layout();
    const FieldShape shape(field);
    FieldFaces faces = facesOf(*field, zero);
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
    const FieldLayout& layout = field.layout();
    std::array<glm::dvec3, 3> steps{};
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 unit(0.0);
        unit[axis] = layout.voxel;
        steps[static_cast<size_t>(axis)] = sceneFromObject.vector(unit);
    }
    return gridOfField(field, sceneFromObject.scale)->file(name, steps, sceneFromObject.point(layout.origin));
}

} // namespace touchstone

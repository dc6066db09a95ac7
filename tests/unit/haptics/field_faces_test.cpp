// The mesh of a field with creases, as it is saved whole and as it is drawn block by block.

#include "haptics/shape/field/save/field_blocks.h"
#include "haptics/shape/field/save/field_export.h"
#include "haptics/shape/field/sculpt/sculptor.h"
#include "tests/support/mesh_distance.h"
#include "tests/unit/haptics/field_bench.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace touchstone::test::field_faces_test {
namespace {

constexpr int kFine = 96;
const double kFineVoxel = cubeOf(kFine).voxel;

/// A ball or a block with fifty cuts and lumps: creases everywhere, some walls thinner than a voxel.
std::shared_ptr<const FieldGrid> creased(const Distance& body, uint32_t seed) {
    Sculptor sculptor(gridOf(body, kFine));
    std::mt19937 random(seed);
    const auto number = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (int i = 0; i < 50; ++i) {
        glm::dvec3 way(number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 1.0));
        way = glm::normalize(way);
        sculptor.apply({.tool = random() % 2 == 0 ? SculptTool::Carve : SculptTool::Add,
                        .centre = number(0.36, 0.44) * way,
                        .radius = number(3.0, 9.0) * kFineVoxel});
    }
    return sculptor.grid();
}

using Place = std::array<int, 3>;
Place rounded(const glm::vec3& p) {
    const glm::dvec3 at = glm::round(1e5 * glm::dvec3(p));
    return {static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z)};
}
using Faces = std::multiset<std::array<Place, 3>>;
/// Triangles by their places, from the least corner on.
template <class Positions>
void addFaces(const Positions& positions, const std::vector<uint32_t>& corners, Faces& faces) {
    for (size_t i = 0; i + 2 < corners.size(); i += 3) {
        std::array<Place, 3> face{rounded(positions[corners[i]]), rounded(positions[corners[i + 1]]),
                                  rounded(positions[corners[i + 2]])};
        std::ranges::rotate(face, std::ranges::min_element(face));
        faces.insert(face);
    }
}

TEST(FieldFaces, LieOnTheSurfaceAndItOnThem) {
    for (const auto& [body, seed] : {std::pair(&ball, 3u), std::pair(&block, 4u), std::pair(&torus, 5u)}) {
        const auto grid = creased(*body, seed);
        const FieldShape shape(grid);
        const SurfaceMesh mesh = meshOfField(grid, Similarity{});
        size_t beside = 0;
        for (const glm::vec3& position : mesh.positions)
            beside += std::abs(shape.value(glm::dvec3(position))) > 0.01 * kFineVoxel ? 1 : 0;
        const Crossings crossings = crossingsOf(*grid, mesh);
        // Each edge of a face is the edge of another one, which runs through it the other way.
        std::map<std::pair<uint32_t, uint32_t>, int> edges;
        for (size_t i = 0; i < mesh.corners.size(); i += 3)
            for (size_t k = 0; k < 3; ++k) {
                const uint32_t from = mesh.corners[i + k], to = mesh.corners[i + (k + 1) % 3];
                edges[std::minmax(from, to)] += from < to ? 1 : -1;
            }
        size_t open = 0;
        for (const auto& [edge, sum] : edges)
            open += sum != 0 ? 1 : 0;
        std::printf(
            "%zu triangles, %zu of %zu vertices beside the surface, %zu crossings within %.3f voxels\n",
            mesh.corners.size() / 3, beside, mesh.positions.size(), crossings.count, crossings.worst);
        EXPECT_GT(crossings.count, 10'000u);
        EXPECT_LT(crossings.worst, 0.4);
        EXPECT_LT(beside, mesh.positions.size() / 100);
        EXPECT_EQ(open, 0u);
    }
}

TEST(FieldFaces, AreTheSameBlockByBlock) {
    for (const uint32_t seed : {3u, 4u}) {
        const auto grid = creased(ball, seed);
        const SurfaceMesh mesh = meshOfField(grid, Similarity{});
        Faces whole, parts;
        addFaces(mesh.positions, mesh.corners, whole);
        FieldBlocks blocks;
        EXPECT_GT(blocks.update(grid, {}), 8u);
        for (const auto& [number, block] : blocks.blocks())
            addFaces(block.positions, block.corners, parts);
        EXPECT_EQ(parts.size(), whole.size());
        EXPECT_TRUE(parts == whole);
    }
}

} // namespace
} // namespace touchstone::test::field_faces_test

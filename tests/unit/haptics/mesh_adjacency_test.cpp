// What lies beyond an edge, from either side of the surface.

#include "assets/shapes.h"
#include "haptics/shape/mesh/mesh_adjacency.h"
#include "haptics/shape/mesh/surface_walk.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace touchstone::test::mesh_adjacency_test {
namespace {

MeshAdjacency adjacencyOf(const assets::Shape& shape) {
    const auto scene = compileHapticScene(sceneOf(shape), Similarity{});
    scene->buildNeighbourhoods();
    return scene->neighbourhoods()->front();
}

/// The answer back is the question, over an edge of the same two vertices.
void expectMutual(const MeshAdjacency& adjacency, const std::vector<uint32_t>& indices) {
    for (TriangleSide side = 0; side < 2 * (indices.size() / 3); ++side)
        for (uint32_t k = 0; k < 3; ++k) {
            const TriangleSide on = adjacency.across(side, k);
            ASSERT_LT(triangleOf(on), indices.size() / 3);
            const uint32_t a = indices[3 * triangleOf(side) + k],
                           b = indices[3 * triangleOf(side) + (k + 1) % 3];
            int back = 0;
            for (uint32_t j = 0; j < 3; ++j) {
                const uint32_t c = indices[3 * triangleOf(on) + j],
                               d = indices[3 * triangleOf(on) + (j + 1) % 3];
                if ((c == a && d == b) || (c == b && d == a))
                    back += adjacency.across(on, j) == side ? 1 : 0;
            }
            EXPECT_EQ(back, 1) << "side " << side << " edge " << k;
        }
}

TEST(MeshAdjacency, ClosedShapesKeepToTheirSideAndObeyEuler) {
    struct Case {
        assets::Shape shape;
        int euler; // V - E + F
    };
    for (const Case& c :
         {Case{assets::boxWithSharedCorners(glm::dvec3(0.1)), 2}, Case{assets::box(glm::dvec3(0.1), 5), 2},
          Case{assets::sphere(0.05, 30, 30), 2}, Case{assets::prism(10, 0.05, 0.15, true, 3), 2},
          Case{assets::torus(0.06, 0.025, 38, 6), 0}}) {
        const auto scene = compileHapticScene(sceneOf(c.shape), Similarity{});
        EXPECT_EQ(scene->neighbourhoods(), nullptr) << "nobody has asked for it yet";
        scene->buildNeighbourhoods();
        const MeshAdjacency& adjacency = scene->neighbourhoods()->front();
        const HapticObject& object = *scene->objects.front();
        const auto faces = static_cast<int>(object.triangleCount());
        EXPECT_EQ(adjacency.borderEdges(), 0u);
        EXPECT_EQ(adjacency.nonManifoldEdges(), 0u);
        EXPECT_EQ(static_cast<int>(object.vertices.size()) - 1 - static_cast<int>(adjacency.edges()) + faces,
                  c.euler);
        EXPECT_EQ(adjacency.memoryBytes(), 24 * object.triangleCount());
        expectMutual(adjacency, object.indices);
        for (TriangleSide side = 0; side < 2 * object.triangleCount(); ++side)
            for (uint32_t k = 0; k < 3; ++k) {
                EXPECT_EQ(adjacency.across(side, k) & 1u, side & 1u); // wound alike all over
                EXPECT_NE(triangleOf(adjacency.across(side, k)), triangleOf(side));
            }
    }
}

TEST(MeshAdjacency, AtAnOpenBorderIsTheOtherSide) {
    const MeshAdjacency adjacency = adjacencyOf(assets::plane(0.1, 0.1, 4, 3));
    EXPECT_EQ(adjacency.borderEdges(), 14u);
    EXPECT_EQ(adjacency.edges(), 4u * 4u + 5u * 3u + 12u);
    int turned = 0;
    for (TriangleSide side = 0; side < 48; ++side)
        for (uint32_t k = 0; k < 3; ++k)
            turned += adjacency.across(side, k) == (side ^ 1u) ? 1 : 0;
    EXPECT_EQ(turned, 28);
}

TEST(MeshAdjacency, TrianglesWoundAgainstEachOtherShareTheirSpaceNotTheirSign) {
    const std::vector<glm::vec3> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, -1, 0}};
    // Both run from 0 to 1: one shows upwards, the other downwards.
    const std::vector<uint32_t> indices{0, 1, 2, 0, 1, 3};
    const MeshAdjacency adjacency(vertices, indices);
    EXPECT_EQ(adjacency.across(0, 0), 3u);
    EXPECT_EQ(adjacency.across(1, 0), 2u);
    expectMutual(adjacency, indices);
}

/// Pages of a book at one spine, wound at random: on each side of a page lies the next page, whatever the
/// angle and the winding. The side is found by geometry: the one that shows towards the middle between them.
TEST(MeshAdjacency, PagesOfABookFollowEachOther) {
    for (const int pages : {3, 4, 5, 17}) {
        std::vector<glm::vec3> vertices{{0.1f, 0.2f, -1.0f}, {0.1f, 0.2f, 1.0f}};
        std::vector<uint32_t> indices;
        for (int p = 0; p < pages; ++p) {
            const double angle = 6.283185307179586 * (p * 7 % pages) / pages + 0.3;
            vertices.emplace_back(0.1 + std::cos(angle), 0.2 + std::sin(angle), 0.1 * p);
            const auto third = static_cast<uint32_t>(2 + p);
            if (p % 3 == 1)
                indices.insert(indices.end(), {1, 0, third});
            else
                indices.insert(indices.end(), {0, 1, third});
        }
        const MeshAdjacency adjacency(vertices, indices);
        EXPECT_EQ(adjacency.nonManifoldEdges(), 1u);
        expectMutual(adjacency, indices);
        for (int p = 0; p < pages; ++p)
            for (const uint32_t back : {0u, 1u}) {
                const uint32_t* i = &indices[3 * static_cast<size_t>(p)];
                const glm::dvec3 a(vertices[i[0]]), b(vertices[i[1]]), c(vertices[i[2]]);
                const glm::dvec3 normal = (back == 0 ? 1.0 : -1.0) * glm::cross(b - a, c - a);
                const TriangleSide on = adjacency.across(2 * static_cast<uint32_t>(p) + back, 0);
                // Which way round the book does this side look, and which page is the next one that way?
                const glm::dvec3 out = c - glm::dvec3(0.1, 0.2, c.z);
                const int turn = glm::cross(out, normal).z > 0.0 ? 1 : -1;
                const int place = p * 7 % pages, following = (place + turn + pages) % pages;
                EXPECT_EQ(static_cast<int>(triangleOf(on)) * 7 % pages, following) << pages << " " << p;
            }
    }
}

TEST(MeshAdjacency, CollapsedTrianglesAreLeftOut) {
    const std::vector<glm::vec3> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    const std::vector<uint32_t> indices{0, 1, 2, 1, 2, 2, 2, 1, 3};
    const MeshAdjacency adjacency(vertices, indices);
    EXPECT_EQ(adjacency.across(0, 1), 4u);
    EXPECT_EQ(adjacency.across(4, 0), 0u);
    EXPECT_EQ(adjacency.edges(), 5u);
}

/// On a flat convex sheet the distance from a place has one minimum. The walk finds it from wherever it
/// starts, also about a vertex of the border, from where it must look to both sides.
TEST(SurfaceWalk, AboutAVertexOfTheBorderItFindsTheNearestPlace) {
    constexpr uint32_t kParts = 9;
    constexpr double kPi = 3.141592653589793;
    assets::Shape fan; // half a disc about the origin
    fan.positions.emplace_back(0.0f);
    for (uint32_t i = 0; i <= kParts; ++i) {
        const double angle = kPi * i / kParts;
        fan.positions.emplace_back(0.05 * std::sin(angle), 0.0, 0.05 * std::cos(angle));
        if (i > 0)
            fan.indices.insert(fan.indices.end(), {0, i, i + 1});
    }
    const auto scene = compileHapticScene(sceneOf(fan), Similarity{});
    scene->buildNeighbourhoods();
    const SurfaceView view{*scene->objects.front(), scene->neighbourhoods()->front()};
    const Similarity workspaceFromObject = scene->restMotions[0].workspaceFromObject;
    for (TriangleSide start = 0; start < 2 * kParts; ++start)
        for (int i = 0; i <= 36; ++i)
            for (const double out : {0.001, 0.02, 0.06})
                for (const double high : {0.004, -0.004}) {
                    const double angle = kPi * (i / 36.0 * 1.2 - 0.1);
                    const glm::dvec3 goal = workspaceFromObject.inversePoint(
                        {out * std::sin(angle), high, out * std::cos(angle)});
                    double nearest = INFINITY;
                    for (TriangleSide side = start & 1u; side < 2 * kParts; side += 2)
                        nearest = std::min(nearest, nearestOnTriangle(view, side, goal).squared);
                    WalkBudget budget{.steps = 64};
                    const SurfacePlace found = walkTowards(view, start, goal, budget);
                    EXPECT_NEAR(found.squared, nearest, 1e-12) << "from " << start << " to " << i;
                    EXPECT_FALSE(budget.spent);
                    EXPECT_EQ(found.side & 1u, start & 1u) << "it stays on its side";
                }
}

} // namespace
} // namespace touchstone::test::mesh_adjacency_test

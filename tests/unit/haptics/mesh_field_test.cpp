// The field of a mesh against all of its triangles: distances by brute force, sides by the parity of
// crossings.

#include "haptics/shape/field/mesh_to_field.h"
#include "tests/unit/haptics/field_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace touchstone::test::mesh_field_test {
namespace {

using Place = glm::vec<3, long double>;

long double distanceFromEdge(const Place& p, const Place& a, const Place& b) {
    const Place edge = b - a;
    const long double squared = glm::dot(edge, edge),
                      t = squared > 0.0L ? std::clamp(glm::dot(p - a, edge) / squared, 0.0L, 1.0L) : 0.0L;
    return glm::length(p - a - t * edge);
}

/// Over the triangle's plane where the perpendicular's foot is inside of all three edges.
long double distanceFromTriangle(const Place& p, const std::array<Place, 3>& t) {
    const Place normal = glm::cross(t[1] - t[0], t[2] - t[0]);
    bool over = glm::dot(normal, normal) > 0.0L;
    long double nearest = std::numeric_limits<long double>::infinity();
    for (size_t k = 0; k < 3; ++k) {
        const Place &a = t[k], &b = t[(k + 1) % 3];
        over = over && glm::dot(glm::cross(b - a, p - a), normal) >= 0.0L;
        nearest = std::min(nearest, distanceFromEdge(p, a, b));
    }
    return over ? std::min(nearest, std::abs(glm::dot(normal, p - t[0])) / glm::length(normal)) : nearest;
}

long double distanceFrom(const HapticObject& mesh, const glm::dvec3& place) {
    long double nearest = std::numeric_limits<long double>::infinity();
    for (size_t i = 0; i < mesh.indices.size(); i += 3)
        nearest = std::min(nearest,
                           distanceFromTriangle(Place(place), {Place(mesh.vertices[mesh.indices[i]]),
                                                               Place(mesh.vertices[mesh.indices[i + 1]]),
                                                               Place(mesh.vertices[mesh.indices[i + 2]])}));
    return nearest;
}

glm::dvec3 placeOf(const FieldGrid& grid, const glm::ivec3& node) {
    return grid.layout().origin + grid.layout().voxel * glm::dvec3(node);
}

template <class Visit>
void eachNode(const FieldGrid& grid, const Visit& visit) {
    const glm::ivec3 last = grid.layout().cells;
    for (int z = 0; z <= last.z; ++z)
        for (int y = 0; y <= last.y; ++y)
            for (int x = 0; x <= last.x; ++x)
                visit(glm::ivec3(x, y, z));
}

struct Body {
    const char* name;
    assets::Shape shape;
};

/// Two bodies in one mesh.
assets::Shape joined(assets::Shape a, const assets::Shape& b, const glm::vec3& away) {
    const auto first = static_cast<uint32_t>(a.positions.size());
    for (const glm::vec3& p : b.positions)
        a.positions.push_back(p + away);
    for (const uint32_t index : b.indices)
        a.indices.push_back(first + index);
    a.normals.clear();
    a.uv.clear();
    a.tangents.clear();
    return a;
}

/// Slivers at the poles of the sphere; a box whose faces and edges lie on nodes.
std::vector<Body> bodies() {
    return {{"torus", assets::torus(0.06, 0.03, 52, 32)},
            {"sphere", assets::sphere(0.075, 40, 40)},
            {"box on nodes", assets::box({0.1, 0.07, 0.05})}};
}

constexpr FieldRequest kRequest{.voxel = 1.0 / 50.0, .inside = 0.2, .outside = 0.04};

TEST(MeshField, IsTheDistanceFromTheNearestOfAllTriangles) {
    std::mt19937 random(3);
    for (const Body& body : bodies()) {
        const TouchBench bench(sceneOf(body.shape));
        const HapticObject& mesh = *bench.scene->objects[0];
        const auto grid = fieldOfMesh(mesh, kRequest);
        double worst = 0.0;
        int compared = 0, beyond = 0;
        eachNode(*grid, [&](const glm::ivec3& node) {
            if (random() % 97 != 0)
                return;
            const double value = grid->node(node), reach = value < 0.0 ? grid->inside() : grid->outside();
            const double right =
                std::min(static_cast<double>(distanceFrom(mesh, placeOf(*grid, node))), reach);
            worst = std::max(worst, std::abs(std::abs(value) - right));
            (right < reach ? compared : beyond) += 1;
        });
        std::printf("%s: %d nodes, worst %.3g of the object\n", body.name, compared, worst);
        EXPECT_GT(compared, 200) << body.name;
        EXPECT_GT(beyond, 50) << body.name;
        EXPECT_LT(worst, 5e-8) << body.name << ": OpenVDB's float within 0.75 voxels, a float at 0.2 beyond";
    }
}

/// OpenVDB, which tells the sides, errs at single nodes beside a surface whose facets are as large as voxels.
constexpr double kBeside = 0.1; // voxels

TEST(MeshField, IsNegativeWhereARayCrossesTheMeshAnOddNumberOfTimes) {
    for (const Body& body : bodies()) {
        const TouchBench bench(sceneOf(body.shape));
        const HapticObject& mesh = *bench.scene->objects[0];
        const auto grid = fieldOfMesh(mesh, kRequest);
        int inside = 0, wrong = 0, all = 0;
        double worst = 0.0; // voxels
        eachNode(*grid, [&](const glm::ivec3& node) {
            const double value = grid->node(node);
            ++all;
            inside += value < 0.0 ? 1 : 0;
            if ((value < 0.0) == insideObject(mesh, placeOf(*grid, node)))
                return;
            ++wrong;
            worst = std::max(worst, std::abs(value) / grid->layout().voxel);
        });
        std::printf("%s: %d of %d nodes on the wrong side, by at most %.3g voxels\n", body.name, wrong, all,
                    worst);
        EXPECT_GT(inside, 1000) << body.name;
        EXPECT_LT(worst, kBeside) << body.name;
    }
}

/// But for rounding: the corners of a triangle come in another order.
TEST(MeshField, DoesNotDependOnWhichWayTheTrianglesFace) {
    assets::Shape mixed = assets::torus(0.06, 0.03, 52, 32);
    const TouchBench all(sceneOf(mixed));
    for (size_t t = 0; t + 2 < mixed.indices.size(); t += 6)
        std::swap(mixed.indices[t + 1], mixed.indices[t + 2]);
    const TouchBench some(sceneOf(mixed));
    const auto one = fieldOfMesh(*all.scene->objects[0], kRequest),
               other = fieldOfMesh(*some.scene->objects[0], kRequest);
    double most = 0.0;
    eachNode(*one, [&](const glm::ivec3& node) {
        most = std::max(most, std::abs(one->node(node) - other->node(node)));
    });
    EXPECT_LT(most, 1e-8);
}

/// The overlap of two bodies is inside of both, and the faces in it leave no zero of the field there.
TEST(MeshField, OverlappingBodiesAreOne) {
    const auto cube = assets::box({0.1, 0.1, 0.1});
    const TouchBench bench(sceneOf(joined(cube, cube, {0.043f, 0.031f, 0.0f})));
    const HapticObject& mesh = *bench.scene->objects[0];
    ASSERT_TRUE(mesh.closed);
    const auto grid = fieldOfMesh(mesh, kRequest);
    int twice = 0;
    eachNode(*grid, [&](const glm::ivec3& node) {
        const double value = grid->node(node);
        if (std::abs(value) < kBeside * grid->layout().voxel)
            return;
        const bool odd = insideObject(mesh, placeOf(*grid, node));
        EXPECT_TRUE(value < 0.0 || !odd);
        twice += value < 0.0 && !odd ? 1 : 0;
    });
    EXPECT_GT(twice, 500);
}

/// Coarse triangles, and triangles that are smaller than a voxel: the distance of a place does not depend on
/// which thread, or which place before it, found its triangle.
TEST(MeshField, IsTheSameToTheBitEachTime) {
    for (const uint32_t across : {12u, 300u}) {
        const TouchBench bench(sceneOf(assets::torus(0.06, 0.03, across, across / 2)));
        const HapticObject& mesh = *bench.scene->objects[0];
        const uint64_t first = fieldOfMesh(mesh, kRequest)->hash();
        for (int i = 0; i < 5; ++i)
            EXPECT_EQ(fieldOfMesh(mesh, kRequest)->hash(), first) << across;
    }
}

} // namespace
} // namespace touchstone::test::mesh_field_test

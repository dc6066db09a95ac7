// What Embree hands us against brute force: no triangle near the proxy is ever left out.

#include "haptics/contact/candidates.h"
#include "haptics/query/ray_floor.h"
#include "haptics/shape/mesh/ray.h"
#include "haptics/shape/mesh/ray_walk.h"
#include "study/truth/brute_force.h"
#include "tests/property/hard_shapes.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace touchstone::test {

using namespace truth;

namespace {

TEST(Embree, AGatheredBallHoldsEveryTriangleThatMeetsIt) {
    for (const auto& shape : {assets::torus(0.06, 0.025, 72, 45), assets::sphere(0.05, 30, 30),
                              assets::box({1000.0, 0.1, 10.0}, 6)}) {
        const auto scene = compileHapticScene(sceneOf(shape), Similarity{});
        const HapticObject& object = *scene->objects[0];
        std::mt19937 random(11);
        std::uniform_real_distribution<double> in(-0.6, 0.6), size(-7.0, -0.5);
        CandidateCache cache;
        size_t found = 0;
        for (int trial = 0; trial < 300; ++trial) {
            glm::dvec3 centre(in(random), in(random), in(random));
            // Half of the balls stand on the surface, where it matters.
            if (trial % 2 == 0)
                centre = glm::dvec3(object.vertices[random() % (object.vertices.size() - 1)]);
            const double radius = std::pow(10.0, size(random));
            if (!cache.gather(scene->objects, scene->restMotions, scene->restSpheres, 0, centre, radius))
                continue;
            for (const BruteContact& contact :
                 bruteWithin(object, LVec3(centre), static_cast<long double>(radius))) {
                bool held = false;
                for (size_t i = 0; i < cache.count(); ++i)
                    held |= cache.item(i).index == contact.triangle;
                EXPECT_TRUE(held) << "triangle " << contact.triangle << " trial " << trial;
                ++found;
            }
        }
        EXPECT_GT(found, 100u);
    }
}

/// Each triangle on its own, a tenth smaller.
assets::Shape apart(const assets::Shape& shape) {
    assets::Shape result;
    for (size_t t = 0; t + 2 < shape.indices.size(); t += 3) {
        glm::dvec3 centre(0.0);
        for (size_t k = 0; k < 3; ++k)
            centre += glm::dvec3(shape.positions[shape.indices[t + k]]) / 3.0;
        for (size_t k = 0; k < 3; ++k) {
            const glm::dvec3 corner(shape.positions[shape.indices[t + k]]);
            result.indices.push_back(static_cast<uint32_t>(result.positions.size()));
            result.positions.emplace_back(centre + 0.9 * (corner - centre));
        }
    }
    return result;
}

TEST(Embree, EveryTriangleThatIsFoundHasACopyOfItsOwnCorners) {
    // In the last no triangle shares a vertex: leaves of 16 have 48.
    for (const auto& shape : {assets::torus(0.06, 0.025, 72, 45), assets::box({1.0, 0.1, 0.1}, 1),
                              assets::sphere(0.05, 12, 12), apart(assets::torus(0.06, 0.025, 40, 30))}) {
        const auto scene = compileHapticScene(sceneOf(shape), Similarity{});
        const HapticObject& object = *scene->objects[0];
        std::vector<TriangleTree::Near> found(object.triangleCount() + 32);
        const size_t count = object.tree.collect(glm::vec3(0.0f), 10.0f, found);
        ASSERT_EQ(count, object.triangleCount() - object.droppedTriangles);
        for (const TriangleTree::Near& near : std::span(found).first(count)) {
            ASSERT_TRUE(TriangleTree::isCopied(near.place));
            for (size_t k = 0; k < 3; ++k)
                EXPECT_EQ(object.tree.corners(near.place)[k],
                          object.vertices[object.indices[3 * size_t{near.triangle} + k]]);
        }
    }
}

/// Lines of memory that a walk asks for beyond its ball, until nothing waits.
uint32_t linesAskedFor(const HapticObject& object, const glm::vec3& centre, float radius,
                       const glm::vec3& next, float nextRadius) {
    std::vector<TriangleTree::Near> found(object.triangleCount() + 32);
    TriangleTree::Ahead ahead{.centre = next, .radius = nextRadius};
    EXPECT_LT(object.tree.collect(centre, radius, found, ahead), found.size());
    for (int tick = 0; tick < 64 && ahead.count > 0; ++tick)
        object.tree.fetchOn(ahead);
    EXPECT_EQ(ahead.count, 0u);
    return TriangleTree::kMostLines - ahead.left;
}

TEST(Embree, AWalkAsksForWhatTheNextBallReadsBeyondItsOwn) {
    const glm::vec3 far(20.0f, 0.0f, 0.0f);
    {
        // All of a small object, once; a node ends with half a line.
        const auto scene = compileHapticScene(sceneOf(assets::torus(0.06, 0.025, 10, 8)), Similarity{});
        const HapticObject& object = *scene->objects[0];
        const uint64_t bytes = object.tree.memoryBytes();
        const uint32_t all = linesAskedFor(object, far, 0.1f, glm::vec3(0.0f), 10.0f);
        EXPECT_GE(all + 4, bytes / 64); // the root is read at once
        EXPECT_LE(all, bytes / 64 * 3 / 2);
        EXPECT_EQ(linesAskedFor(object, far, 0.1f, far, 10.0f), 0u);
        EXPECT_EQ(linesAskedFor(object, glm::vec3(0.0f), 10.0f, glm::vec3(0.0f), 10.0f), 0u);
    }
    const auto scene = compileHapticScene(sceneOf(assets::torus(0.06, 0.025, 180, 90)), Similarity{});
    const HapticObject& object = *scene->objects[0];
    EXPECT_EQ(linesAskedFor(object, far, 0.1f, glm::vec3(0.0f), 10.0f), TriangleTree::kMostLines);
    const glm::vec3 here = object.vertices[100], next = object.vertices[110];
    const uint32_t beside = linesAskedFor(object, here, 0.005f, next, 0.01f);
    EXPECT_GT(beside, 3u);
    EXPECT_LT(beside, TriangleTree::kMostLines / 2);
    // Of what its own ball reads it asks for nothing.
    EXPECT_LT(linesAskedFor(object, here, 0.02f, next, 0.01f), beside);
}

TEST(Embree, TheInsideTestAgreesWithTheClosedForm) {
    const auto scene = compileHapticScene(sceneOf(assets::torus(0.06, 0.025, 72, 45)), Similarity{});
    const HapticObject& object = *scene->objects[0];
    ASSERT_TRUE(object.closed);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> in(-0.1, 0.1);
    int inside = 0;
    for (int trial = 0; trial < 5000; ++trial) {
        const glm::dvec3 p(in(random), in(random), 0.4 * in(random));
        const double ring = std::hypot(p.x, p.y) - 0.06;
        const double depth = 0.025 - std::hypot(ring, p.z);
        if (std::abs(depth) < 2e-4)
            continue; // between the facets and the torus
        const bool found = insideObject(object, object.workspaceFromObject.inverse().point(p));
        EXPECT_EQ(found, depth > 0.0) << "depth " << depth;
        inside += found ? 1 : 0;
    }
    EXPECT_GT(inside, 500);
}

/// The distances at which a ray crosses an object, by trying all triangles in long double.
std::vector<long double> crossedBy(const HapticObject& object, const LVec3& from, const LVec3& direction) {
    std::vector<long double> found;
    for (uint32_t t = 0; t < object.triangleCount(); ++t) {
        const auto corner = [&](size_t k) {
            return LVec3(object.vertices[object.indices[3 * t + k]]) - from;
        };
        const LVec3 a = corner(0), b = corner(1), c = corner(2), area = glm::cross(b - a, c - a);
        const long double ab = glm::dot(direction, glm::cross(a, b)),
                          bc = glm::dot(direction, glm::cross(b, c)),
                          ca = glm::dot(direction, glm::cross(c, a));
        const bool one = ab > 0 && bc > 0 && ca > 0, other = ab < 0 && bc < 0 && ca < 0;
        if ((one || other) && glm::dot(a, area) / glm::dot(direction, area) > 0)
            found.push_back(glm::dot(a, area) / glm::dot(direction, area));
    }
    return found;
}

TEST(RayWalk, CountsAndFindsWhatLongDoubleDoesOnHardShapes) {
    std::mt19937 random(21);
    std::normal_distribution<double> any;
    std::uniform_real_distribution<double> in(-0.6, 0.6), depth(-7.0, -1.0);
    size_t crossed = 0, agreed = 0;
    for (const HardShape& hard : hardShapes()) {
        const auto scene =
            compileHapticScene(sceneOf(hard.shape), Similarity{}, {.rays = true, .progress = {}});
        const HapticObject& object = *scene->objects[0];
        for (int trial = 0; trial < 300; ++trial) {
            glm::dvec3 from(in(random), in(random), in(random));
            // A third starts next to the surface, a third far away.
            if (trial % 3 == 0)
                from = glm::dvec3(object.vertices[random() % (object.vertices.size() - 1)]) +
                       std::pow(10.0, depth(random)) * glm::dvec3(any(random), any(random), any(random));
            if (trial % 3 == 1)
                from *= 100.0;
            const glm::dvec3 at(0.7 * in(random), 0.7 * in(random), 0.7 * in(random));
            const glm::dvec3 direction =
                trial % 3 == 1 ? glm::normalize(at - from)
                               : glm::normalize(glm::dvec3(any(random), any(random), any(random)));
            const std::vector<long double> truth = crossedBy(object, LVec3(from), LVec3(direction));
            EXPECT_EQ(crossings(object, from, direction), truth.size()) << hard.name << " " << trial;
            const auto first = firstCrossing(object, from, direction, false);
            ASSERT_EQ(first.has_value(), !truth.empty()) << hard.name << " " << trial;
            if (!first)
                continue;
            const auto nearest = static_cast<double>(*std::min_element(truth.begin(), truth.end()));
            EXPECT_NEAR(first->distance, nearest, 1e-9 * (1.0 + nearest)) << hard.name << " " << trial;
            ++crossed;
            const auto hit = castRay(object, glm::vec3(from), glm::vec3(direction), 0.0f, 1e30f);
            agreed += hit && std::abs(static_cast<double>(hit->distance) - nearest) < 1e-4 * (1.0 + nearest)
                          ? 1
                          : 0;
        }
    }
    EXPECT_GT(crossed, 500u);
    EXPECT_GT(static_cast<double>(agreed), 0.98 * static_cast<double>(crossed)) << "Embree's, in float";
}

TEST(RayWalk, ARayThroughEdgesLeaksThroughNoClosedMesh) {
    const auto scene = compileHapticScene(sceneOf(assets::torus(0.06, 0.025, 72, 45)), Similarity{});
    const HapticObject& object = *scene->objects[0];
    std::mt19937 random(5);
    std::normal_distribution<double> any;
    for (int trial = 0; trial < 20000; ++trial) {
        // Through the very middle of an edge, as nearly as doubles go.
        const uint32_t corner = static_cast<uint32_t>(random() % object.indices.size());
        const uint32_t next = corner - corner % 3 + (corner + 1) % 3;
        const glm::dvec3 middle = 0.5 * (glm::dvec3(object.vertices[object.indices[corner]]) +
                                         glm::dvec3(object.vertices[object.indices[next]]));
        const glm::dvec3 from = 2.0 * glm::normalize(glm::dvec3(any(random), any(random), any(random)));
        const auto count = crossings(object, from, middle - from);
        ASSERT_TRUE(count);
        EXPECT_EQ(*count % 2, 0u) << trial;
    }
}

TEST(Embree, TheFloorRayMeetsTheSurfaceBetweenProxyAndHip) {
    TouchBench bench(sceneOf(assets::sphere(0.05, 30, 30)));
    bench.moveTo({0.0, 0.07, 0.003}, 0.1);
    bench.moveTo({0.0, 0.048, 0.003}, 0.1);
    ASSERT_GT(bench.output.contacts, 0u);
    const float hit = castFloorRay(*bench.scene, 0, bench.output.proxy, bench.output.hip);
    EXPECT_GT(hit, 0.0f);
    EXPECT_LT(hit, 1.0f);
}

} // namespace
} // namespace touchstone::test

#include "haptics/shape/mesh/weld.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

namespace touchstone::weld_test {
namespace {

/// What weldVertices says it does, by comparing every vertex with every cluster.
WeldResult weldByComparing(const std::vector<glm::vec3>& points, double tolerance) {
    WeldResult weld;
    for (const glm::vec3& p : points) {
        const auto near = [&](const glm::vec3& v) {
            return glm::distance(glm::dvec3(v), glm::dvec3(p)) <= tolerance;
        };
        const auto found = std::find_if(weld.vertices.begin(), weld.vertices.end(), near);
        weld.remap.push_back(static_cast<uint32_t>(found - weld.vertices.begin()));
        if (found == weld.vertices.end())
            weld.vertices.push_back(p);
        else
            weld.merged += *found != p ? 1 : 0;
    }
    return weld;
}

TEST(Weld, AgreesWithComparingAllVertices) {
    constexpr float kTolerance = 1e-6f;
    std::mt19937 random(4);
    // From clouds of which all is one cluster to such as hardly meet; on the walls of cells and across zero.
    for (const float spread : {1e-7f, 1e-6f, 4e-6f, 1e-5f, 3e-5f, 1e-3f, 1.0f})
        for (const float lattice : {0.0f, 1e-6f, 4e-6f}) {
            std::uniform_real_distribution<float> in(-spread, spread);
            std::vector<glm::vec3> points(1500);
            for (glm::vec3& p : points) {
                p = {in(random), in(random), random() % 4 == 0 ? 0.0f : in(random)};
                if (lattice > 0.0f)
                    p = lattice * glm::round(p / lattice);
                if (random() % 3 == 0)
                    p = points[random() % points.size()];
            }
            const WeldResult fast = weldVertices(points, static_cast<double>(kTolerance)),
                             slow = weldByComparing(points, static_cast<double>(kTolerance));
            EXPECT_EQ(fast.remap, slow.remap) << spread << " " << lattice;
            EXPECT_EQ(fast.vertices, slow.vertices) << spread << " " << lattice;
            EXPECT_EQ(fast.merged, slow.merged) << spread << " " << lattice;
        }
}

TEST(Weld, AChainOfNearVerticesDoesNotCollapse) {
    std::vector<glm::vec3> points;
    for (int i = 0; i < 100; ++i)
        points.emplace_back(0.7e-6f * static_cast<float>(i), 0.0f, 0.0f);
    const WeldResult fast = weldVertices(points, 1e-6), slow = weldByComparing(points, 1e-6);
    EXPECT_EQ(fast.remap, slow.remap);
    EXPECT_EQ(fast.vertices.size(), 50u);
}

TEST(Weld, JoinsWhatIsNearAndKeepsWhatIsFar) {
    const std::vector<glm::vec3> points{{0, 0, 0}, {1e-7f, 0, 0}, {1, 0, 0}, {1, 2e-6f, 0}, {0, 0, 0}};
    const WeldResult weld = weldVertices(points, 1e-6);
    EXPECT_EQ(weld.remap, (std::vector<uint32_t>{0, 0, 1, 2, 0}));
    EXPECT_EQ(weld.merged, 1u) << "a repeat of the same place is no weld";
}

TEST(Weld, NoVertexMovesFartherThanTheTolerance) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> in(-1e-5f, 1e-5f);
    std::vector<glm::vec3> points(5000);
    for (glm::vec3& p : points)
        p = {in(random), in(random), in(random)};
    const WeldResult weld = weldVertices(points, 1e-6);
    for (size_t i = 0; i < points.size(); ++i)
        EXPECT_LE(glm::distance(glm::dvec3(points[i]), glm::dvec3(weld.vertices[weld.remap[i]])), 1e-6);
    EXPECT_LT(weld.vertices.size(), points.size());
}

TEST(Weld, ClosedMeansEveryEdgeTwice) {
    const std::vector<uint32_t> tetrahedron{0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0};
    EXPECT_TRUE(isClosed(tetrahedron, 4));
    EXPECT_FALSE(isClosed(std::span(tetrahedron).first(9), 4));
    EXPECT_FALSE(isClosed({}, 0));
}

bool closedByCounting(const std::vector<uint32_t>& indices) {
    std::map<std::set<uint32_t>, int> edges;
    for (size_t t = 0; t + 2 < indices.size(); t += 3) {
        const std::set<uint32_t> corners(indices.begin() + static_cast<std::ptrdiff_t>(t),
                                         indices.begin() + static_cast<std::ptrdiff_t>(t + 3));
        for (size_t k = 0; k < 3 && corners.size() == 3; ++k)
            ++edges[{indices[t + k], indices[t + (k + 1) % 3]}];
    }
    return !edges.empty() && std::ranges::all_of(edges, [](const auto& e) { return e.second % 2 == 0; });
}

TEST(Weld, ClosedAgreesWithCountingOnAnySoup) {
    std::mt19937 random(9);
    const auto below = [&](uint32_t end) { return static_cast<uint32_t>(random() % end); };
    size_t closed = 0;
    for (int trial = 0; trial < 4000; ++trial) {
        const uint32_t vertices = 3 + below(4); // few: edges of two, three, four triangles, collapsed ones
        std::vector<uint32_t> indices;
        for (size_t t = 0; t < 1 + below(5); ++t) {
            const uint32_t a = below(vertices), b = below(vertices), c = below(vertices);
            indices.insert(indices.end(), {a, b, c});
            if (below(3) != 0)
                indices.insert(indices.end(), {a, c, b});
        }
        EXPECT_EQ(isClosed(indices, vertices), closedByCounting(indices)) << trial;
        closed += isClosed(indices, vertices) ? 1 : 0;
    }
    EXPECT_GT(closed, 400u);
    EXPECT_LT(closed, 3600u);
}

TEST(Weld, AVertexOfManyEdgesTakesNoSquareOfThem) {
    std::vector<uint32_t> fan; // a closed double cone: half a million edges at its two tips
    constexpr uint32_t kRim = 500'000;
    for (uint32_t i = 0; i < kRim; ++i) {
        const uint32_t next = (i + 1) % kRim;
        fan.insert(fan.end(), {kRim, i, next, kRim + 1, next, i});
    }
    EXPECT_TRUE(isClosed(fan, kRim + 2));
    std::ranges::transform(fan, fan.begin(), [](uint32_t v) { return v >= kRim ? v - kRim : v + 2; });
    EXPECT_TRUE(isClosed(fan, kRim + 2)) << "the tips are the lower ends";
}

} // namespace
} // namespace touchstone::weld_test

#include "haptics/contact/weld.h"

#include <gtest/gtest.h>

#include <random>

namespace touchstone {
namespace {

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
    EXPECT_TRUE(isClosed(tetrahedron));
    EXPECT_FALSE(isClosed(std::span(tetrahedron).first(9)));
    EXPECT_FALSE(isClosed({}));
}

} // namespace
} // namespace touchstone

// A refitted tree finds what a search through all triangles finds, at both ends and between.
#include "haptics/shape/mesh/triangle_tree.h"
#include "tests/unit/deforming/deforming_bench.h"

#include <random>
#include <set>

namespace touchstone::test {
namespace {

TEST(TriangleRefit, FindsAllTrianglesOfBothEndsAndBetween) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> unit(-0.5f, 0.5f);
    for (const size_t triangles : {size_t{1}, size_t{5}, size_t{40}, size_t{3000}}) {
        std::vector<glm::vec3> first, a, b;
        std::vector<uint32_t> indices;
        for (size_t v = 0; v < 3 * triangles; ++v) {
            const glm::vec3 centre(unit(random), unit(random), unit(random));
            first.push_back(centre);
            a.push_back(glm::vec3(unit(random), unit(random), unit(random)));
            b.push_back(a.back() + 0.1f * glm::vec3(unit(random), unit(random), unit(random)));
            indices.push_back(static_cast<uint32_t>(v));
        }
        TriangleTree tree(first, indices);
        tree.refit(a, b, indices);
        std::vector<TriangleTree::Near> found(4 * triangles + 64);
        for (int query = 0; query < 50; ++query) {
            const glm::vec3 centre(unit(random), unit(random), unit(random));
            const float radius = 0.05f + 0.1f * std::abs(unit(random)), t = 0.5f + unit(random);
            const size_t count = tree.collect(centre, radius, found);
            ASSERT_LT(count, found.size());
            std::set<uint32_t> seen;
            for (size_t i = 0; i < count; ++i)
                seen.insert(found[i].triangle);
            for (uint32_t k = 0; k < triangles; ++k) {
                std::array<LVec3, 3> now;
                for (size_t c = 0; c < 3; ++c)
                    now[c] = LVec3(a[3 * k + c]) +
                             static_cast<long double>(t) * (LVec3(b[3 * k + c]) - LVec3(a[3 * k + c]));
                if (distanceFrom(now, LVec3(centre)) < static_cast<long double>(radius)) {
                    ASSERT_TRUE(seen.contains(k)) << triangles << " triangles, " << k;
                }
            }
        }
    }
}

} // namespace
} // namespace touchstone::test

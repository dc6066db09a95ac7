// A refitted tree finds what a search through all triangles finds, at both ends and between.
#include "haptics/shape/mesh/triangle_tree.h"
#include "tests/unit/deforming/deforming_bench.h"

#include <random>
#include <set>

namespace touchstone::test::triangle_refit_test {
namespace {

/// `farthest`: where the deformation takes what was of magnitude one.
void checkRefitted(float farthest) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> unit(-0.5f, 0.5f);
    const auto place = [&] { return farthest * glm::vec3(unit(random), unit(random), unit(random)); };
    for (const size_t triangles : {size_t{1}, size_t{5}, size_t{40}, size_t{3000}}) {
        std::vector<glm::vec3> first, a, b;
        std::vector<uint32_t> indices;
        for (size_t v = 0; v < 3 * triangles; ++v) {
            const glm::vec3 centre(unit(random), unit(random), unit(random));
            first.push_back(centre);
            a.push_back(place());
            b.push_back(a.back() + 0.1f * place());
            indices.push_back(static_cast<uint32_t>(v));
        }
        TriangleTree tree(first, indices);
        tree.refit(a, b, indices);
        std::vector<TriangleTree::Near> found(4 * triangles + 64);
        for (int query = 0; query < 50; ++query) {
            const glm::vec3 centre = place();
            const float radius = farthest * (0.05f + 0.1f * std::abs(unit(random))), t = 0.5f + unit(random);
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

TEST(TriangleRefit, FindsAllTrianglesOfBothEndsAndBetween) {
    checkRefitted(1.0f);
}

/// Failed: boxes were rounded as at magnitude one, so that triangles far out lay outside of them; flat ones
/// got a byte of -53.
TEST(TriangleRefit, FindsThemWhereverADeformationTakesThem) {
    for (const float farthest : {60.0f, 1e4f, 1e8f})
        checkRefitted(farthest);
    const std::vector<glm::vec3> flat{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
        far{{0, 0, 900}, {1, 0, 900}, {0, 1, 900}}, none(3, glm::vec3(NAN));
    const std::vector<uint32_t> indices{0, 1, 2};
    TriangleTree tree(flat, indices);
    std::vector<TriangleTree::Near> found(64);
    tree.refit(far, far, indices);
    EXPECT_EQ(tree.collect({0.2f, 0.2f, 900.0f}, 0.01f, found), 1u);
    tree.refit(none, none, indices);
    EXPECT_LE(tree.collect({0.2f, 0.2f, 0.0f}, 0.01f, found), 1u);
}

} // namespace
} // namespace touchstone::test::triangle_refit_test

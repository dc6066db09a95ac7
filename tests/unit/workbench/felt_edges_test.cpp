// The legend of what people may feel has the study's angles in the order of the colours, and its counts.

#include "renderer/false_color.h"
#include "study/perception/perceptual_check.h"
#include "tests/support/touch_bench.h"
#include "workbench/screen/felt_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace touchstone::felt_edges_test {
namespace {

TEST(FeltEdges, TheViewHasTheAnglesOfTheStudy) {
    std::vector<double> angles;
    for (const study::FacetLimit& limit : study::facetLimits())
        angles.push_back(limit.degrees);
    std::ranges::sort(angles);
    EXPECT_TRUE(std::ranges::equal(angles, kFeltAngles));
}

TEST(FeltEdges, TheLegendCountsTheEdgesBeyondEachAngle) {
    // Ten sides of 36 degrees; the rims of both caps are creases.
    const auto scene = compileHapticScene(test::sceneOf(assets::prism(10, 0.05, 0.2, true)), Similarity{});
    const std::vector<EffectColors::Kind> legend = feltColors(*scene);
    ASSERT_EQ(legend.size(), kFeltAngles.size() + 1);
    EXPECT_EQ(legend[0].effects, "> 14.8\u00b0: 10 edges; force and tactile shading");
    EXPECT_EQ(legend[4].effects, "> 0.2\u00b0: 10 edges; force without shading, contact location");
    EXPECT_NE(legend[5].effects.find("20 creases"), std::string::npos) << legend[5].effects;
    for (size_t i = 0; i + 1 < legend.size(); ++i)
        EXPECT_NE(legend[i].color, legend[i + 1].color);
    EXPECT_EQ(legend[0].color, falseColor(1.0));
    const auto flat = compileHapticScene(test::sceneOf(assets::prism(10, 0.05, 0.2, false)), Similarity{});
    EXPECT_NE(feltColors(*flat)[0].effects.find("no smooth normals"), std::string::npos);
}

/// The picture and the legend tell the same: vertices of the class k touch an edge beyond the k-th angle.
TEST(FeltEdges, ThePictureAgreesWithTheCounts) {
    const Scene prism = test::sceneOf(assets::prism(200, 0.05, 0.2, true)); // 1.8 degrees
    std::vector<float> steps = feltSteps(prism.meshes[0]);
    EXPECT_EQ(*std::ranges::max_element(steps), 2.0f) << "beyond 0.2 and 0.5";
    const Scene flat = test::sceneOf(assets::prism(10, 0.05, 0.2, false));
    steps = feltSteps(flat.meshes[0]);
    // Each face has normals of its own: only its diagonal is no crease, and that is flat.
    EXPECT_EQ(*std::ranges::max_element(steps), 0.0f);
    Mesh roof;
    const auto c = static_cast<float>(std::cos(glm::radians(1.0))),
               d = static_cast<float>(std::sin(glm::radians(1.0)));
    roof.positions = {{0, 0, 0}, {0, 0, 1}, {c, -d, 0}, {0, 0, 1}, {0, 0, 0}, {-c, -d, 0}};
    roof.indices = {0, 1, 2, 3, 4, 5};
    EXPECT_EQ(feltSteps(roof), (std::vector<float>{2, 2, -1, 2, 2, -1})) << "two degrees";
    EXPECT_TRUE(feltSteps(Mesh{}).empty());
}

} // namespace
} // namespace touchstone::felt_edges_test

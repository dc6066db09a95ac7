// The slice of a field against the closed form of a ball.

#include "tests/unit/haptics/field_bench.h"
#include "workbench/screen/field_slice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

namespace touchstone::test::field_slice_test {
namespace {

constexpr double kScale = 0.15, kRadius = 0.4 * kScale; // m

TEST(FieldSlice, IsolinesAreWhereTheDistanceIsAndArrowsAlongItsGradient) {
    const FieldBench bench(fieldOf(ball, 64), kScale);
    const FieldSlice slice{.axis = 2, .at = 0.5};
    Overlay overlay;
    const SliceFigures figures = drawFieldSlice(*bench.scene, slice, 2.0f, overlay);
    EXPECT_NEAR(figures.place, 0.0, 0.001);
    EXPECT_DOUBLE_EQ(figures.spacing, 0.005) << "30 mm inside in six";
    EXPECT_EQ(figures.lines, overlay.lines.size());
    EXPECT_EQ(figures.arrows, overlay.arrows.size());
    std::set<long> levels;
    double around = 0.0;
    for (const Overlay::Line& line : overlay.lines) {
        const double radius = glm::distance(line.from, FieldBench::kMiddle);
        const auto level = std::lround((radius - kRadius) / figures.spacing);
        levels.insert(level);
        for (const glm::dvec3& end : {line.from, line.to}) {
            EXPECT_NEAR(glm::distance(end, FieldBench::kMiddle),
                        kRadius + static_cast<double>(level) * figures.spacing, 1e-4);
            EXPECT_NEAR(end.z, figures.place, 1e-12);
        }
        const bool white = line.color == glm::vec4(1.0f);
        EXPECT_EQ(white, level == 0);
        EXPECT_EQ(line.width, white ? 5.0f : 3.0f);
        around += white ? glm::distance(line.from, line.to) : 0.0;
    }
    EXPECT_EQ(levels, (std::set<long>{-5, -4, -3, -2, -1, 0, 1, 2})) << "30 mm inside and 15 mm outside";
    EXPECT_NEAR(around, 2.0 * std::numbers::pi * kRadius, 0.01 * 2.0 * std::numbers::pi * kRadius);
    EXPECT_GT(overlay.arrows.size(), 100u);
    for (const Overlay::Arrow& arrow : overlay.arrows) {
        const double radius = glm::distance(arrow.from, FieldBench::kMiddle) / kScale;
        if (radius < 0.27 || radius > 0.43) // nodes beyond the field's reach are flat
            continue;
        const glm::dvec3 radial = glm::normalize(arrow.from - FieldBench::kMiddle);
        EXPECT_GT(glm::dot(glm::normalize(arrow.to - arrow.from), radial), 0.999);
    }
    EXPECT_NE(figures.label(slice).find("isolines every 5 mm"), std::string::npos) << figures.label(slice);
}

TEST(FieldSlice, ShowsNothingWhereNothingIsFeltAsAField) {
    const TouchBench bench(cornerScene({{.normal = {0, 1, 0}, .stiffness = 600.0}}), cornerSettings());
    Overlay overlay;
    const FieldSlice slice{.axis = 0};
    const SliceFigures figures = drawFieldSlice(*bench.scene, slice, 1.0f, overlay);
    EXPECT_EQ(figures.lines + figures.arrows, 0u);
    EXPECT_TRUE(overlay.empty());
    EXPECT_EQ(figures.label(slice), "nothing here is felt as a field");
}

/// It is kept from frame to frame, and drawn anew where the field is another one.
TEST(FieldSlice, IsDrawnAnewWhereTheFieldDiffers) {
    const FieldBench large(fieldOf(ball, 48), kScale), small(fieldOf(ball, 48), 0.5 * kScale);
    FieldSliceView view;
    Overlay first, again, other, none;
    const FieldSlice slice{.axis = 1};
    view.draw(large.scene, slice, 1.0f, first);
    view.draw(large.scene, slice, 1.0f, again);
    view.draw(small.scene, slice, 1.0f, other);
    ASSERT_EQ(first.lines.size(), again.lines.size());
    EXPECT_EQ(first.lines.front().from, again.lines.front().from);
    EXPECT_NE(first.lines.front().from, other.lines.front().from);
    EXPECT_FALSE(view.label().empty());
    view.draw(small.scene, {}, 1.0f, none);
    EXPECT_TRUE(none.empty());
    EXPECT_TRUE(view.label().empty());
}

} // namespace
} // namespace touchstone::test::field_slice_test

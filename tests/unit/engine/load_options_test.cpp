// Progress and cancellation of a load.

#include "engine/core/progress.h"
#include "tests/unit/engine/load_support.h"

#include <cmath>

namespace touchstone::load_options_test {
namespace {

using test::GltfMaker;

struct Reports {
    std::vector<double> fractions;
    [[nodiscard]] LoadOptions options() {
        LoadOptions options;
        options.progress = [this](double fraction, const char* what) {
            fractions.push_back(fraction);
            EXPECT_NE(std::string(what), "");
        };
        return options;
    }
    [[nodiscard]] double longestStep() const {
        double longest = fractions.front();
        for (size_t i = 1; i < fractions.size(); ++i)
            longest = std::max(longest, fractions[i] - fractions[i - 1]);
        return longest;
    }
};

/// A wavy sheet of 2 * side * side triangles without normals.
GltfMaker sheet(uint32_t side) {
    std::vector<float> positions;
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i <= side; ++i)
        for (uint32_t k = 0; k <= side; ++k) {
            const float x = static_cast<float>(i) / static_cast<float>(side),
                        y = static_cast<float>(k) / static_cast<float>(side);
            positions.insert(positions.end(), {x, y, 0.05f * std::sin(9.0f * x) * std::sin(7.0f * y)});
            if (i == side || k == side)
                continue;
            const uint32_t at = i * (side + 1) + k;
            indices.insert(indices.end(), {at, at + side + 1, at + 1, at + 1, at + side + 1, at + side + 2});
        }
    GltfMaker maker;
    const size_t p = maker.addAccessor(positions, "VEC3"), t = maker.addAccessor(indices, "SCALAR");
    maker.json["accessors"][p]["min"] = {0, 0, -0.05};
    maker.json["accessors"][p]["max"] = {1, 1, 0.05};
    maker.show(
        maker.append("meshes", {{"primitives", {{{"attributes", {{"POSITION", p}}}, {"indices", t}}}}}));
    return maker;
}

TEST(LoadOptions, CancelStopsALoadBeforeItsNextStep) {
    const std::atomic<bool> cancel{true};
    LoadOptions options;
    options.cancel = &cancel;
    EXPECT_EQ(test::errorOf([&] { return test::load(GltfMaker::square(), options); }).problem(), "cancelled");
}

TEST(LoadOptions, ProgressRisesToOne) {
    Reports reports;
    (void)test::load(GltfMaker::square(), reports.options());
    ASSERT_GE(reports.fractions.size(), 3u);
    EXPECT_TRUE(std::is_sorted(reports.fractions.begin(), reports.fractions.end()));
    EXPECT_EQ(reports.fractions.back(), 1.0);
}

/// The window's bar moves throughout: every long loop reports after kProgressWork items.
TEST(LoadOptions, ALargeMeshReportsThroughout) {
    Reports small, large;
    (void)test::load(sheet(8), small.options());
    constexpr uint32_t kSide = 400; // 320,000 triangles
    (void)test::load(sheet(kSide), large.options());
    EXPECT_TRUE(std::is_sorted(large.fractions.begin(), large.fractions.end()));
    EXPECT_EQ(large.fractions.back(), 1.0);
    // The file's indices are looked at once, and measured once.
    constexpr size_t kItems = 6 * kSide * kSide;
    EXPECT_GE(large.fractions.size(), small.fractions.size() + 2 * (kItems / kProgressWork));
    EXPECT_LE(large.longestStep(), 0.3);
}

TEST(LoadOptions, ALoadStopsAtTheNextReportAfterItIsCancelled) {
    for (const double at : {0.1, 0.3, 0.5, 0.8}) {
        std::atomic<bool> cancel{false};
        int after = 0;
        LoadOptions options;
        options.cancel = &cancel;
        options.progress = [&](double fraction, const char*) {
            after += cancel ? 1 : 0;
            cancel = cancel || fraction >= at;
        };
        EXPECT_EQ(test::errorOf([&] { return test::load(sheet(200), options); }).problem(), "cancelled")
            << at;
        EXPECT_LE(after, 1) << at << ": a step checks before it reports";
    }
}

} // namespace
} // namespace touchstone::load_options_test

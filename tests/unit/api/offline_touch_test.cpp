// Offline touch through the library: `touchstone touch` to the last bit, and exact where a formula is.

#include "tests/support/program.h"
#include "tests/unit/api/floor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <fstream>

namespace touchstone::test {
namespace {

std::vector<std::vector<double>> rowsOf(const std::filesystem::path& csv) {
    std::vector<std::vector<double>> rows;
    std::ifstream in(csv);
    std::string line;
    std::getline(in, line); // names
    while (std::getline(in, line)) {
        std::vector<double>& row = rows.emplace_back();
        const char* const end = line.data() + line.size();
        for (const char* at = line.data(); at < end; ++at) {
            double value = 0.0;
            at = std::from_chars(at, end, value).ptr;
            row.push_back(value);
        }
    }
    return rows;
}

void writePath(const std::filesystem::path& file, const std::vector<double>& times,
               const std::vector<ts::Vector>& path) {
    std::string text = "t,x,y,z\n";
    for (size_t i = 0; i < path.size(); ++i) {
        char row[128];
        std::snprintf(row, sizeof row, "%.17g,%.17g,%.17g,%.17g\n", times[i], path[i][0], path[i][1],
                      path[i][2]);
        text += row;
    }
    writeTextFile(file, text);
}

/// Columns of TICKS.csv: t, hip 1-3, proxy 4-6, normal 7-9, force 10-12.
constexpr size_t kProxy = 4, kForce = 10;

size_t differing(const std::vector<std::vector<double>>& rows, const ts::Ticks& ticks) {
    size_t count = 0;
    for (size_t i = 0; i < rows.size(); ++i)
        for (size_t axis = 0; axis < 3; ++axis)
            count += rows[i][kForce + axis] != ticks.force[i][axis] ||
                     rows[i][kProxy + axis] != ticks.proxy[i][axis];
    return count;
}

class SameAsTheProgram : public testing::TestWithParam<const char*> {};

TEST_P(SameAsTheProgram, InEveryTick) {
    const ScratchFolder folder;
    const std::filesystem::path model = std::filesystem::path(TOUCHSTONE_ASSETS) / GetParam();
    const ts::Scene scene(model.string());
    const std::vector<ts::Vector> stroke = scene.stroke();
    ASSERT_GT(stroke.size(), 1000u);
    std::vector<double> times(stroke.size());
    for (size_t i = 0; i < times.size(); ++i)
        times[i] = 0.5 + static_cast<double>(i) * 1e-3;
    writePath(folder / "hip.csv", times, stroke);
    const ProgramResult run =
        runProgram({TOUCHSTONE_BINARY, "touch", model.string(), "--path", (folder / "hip.csv").string(),
                    "--out", (folder / "ticks.csv").string(), "--set", "passivity=control"});
    ASSERT_EQ(run.status, 0) << run.err;
    const auto rows = rowsOf(folder / "ticks.csv");
    ASSERT_EQ(rows.size(), stroke.size());

    ts::Ticks ticks(stroke.size());
    ts_path path = TS_STRUCT(ts_path);
    path.positions = stroke.data()->data();
    path.times = times.data();
    path.count = stroke.size();
    const ts_ticks arrays = ticks.arrays();
    ts::Settings settings;
    settings.set("passivity", "control");
    ts::check(ts_touch(scene.get(), settings.get(), &path, &arrays));
    EXPECT_EQ(differing(rows, ticks), 0u);
    size_t contact = 0;
    for (const uint32_t contacts : ticks.contacts)
        contact += contacts > 0;
    EXPECT_GT(contact, stroke.size() / 20);
    // A setting that matters shows the comparison's eyes are open.
    settings.set("stiffness", "200");
    ts::check(ts_touch(scene.get(), settings.get(), &path, &arrays));
    EXPECT_GT(differing(rows, ticks), contact);
}
INSTANTIATE_TEST_SUITE_P(OfflineTouch, SameAsTheProgram,
                         testing::Values("doughnut.glb", "swatches.glb", "field_torus.glb", "moving.glb",
                                         "breathing.glb", "programs.glb", "wood.glb"));

/// The stroke that the library lays is the program's.
TEST(OfflineTouch, LaysTheProgramsStroke) {
    const ScratchFolder folder;
    const std::string model = TOUCHSTONE_ASSETS "/doughnut.glb";
    const ProgramResult run = runProgram(
        {TOUCHSTONE_BINARY, "touch", model, "--stroke", "circle", "--out", (folder / "ticks.csv").string()});
    ASSERT_EQ(run.status, 0) << run.err;
    const auto rows = rowsOf(folder / "ticks.csv");
    const std::vector<ts::Vector> stroke = ts::Scene(model).stroke("circle");
    ASSERT_EQ(rows.size(), stroke.size());
    for (size_t i = 0; i < rows.size(); ++i)
        for (size_t axis = 0; axis < 3; ++axis)
            ASSERT_EQ(rows[i][1 + axis], stroke[i][axis]) << i;
}

/// A floor out of arrays: the force is stiffness times depth.
TEST(OfflineTouch, FeelsAFloorOutOfArrays) {
    ts::Material stiff;
    stiff.stiffness = 800.0;
    stiff.staticFriction = stiff.dynamicFriction = 0.0;
    const ts::Scene scene({floorMesh()}, {stiff});
    EXPECT_EQ(scene.info().triangles, 2u);
    const std::vector<float> corners = scene.triangles();
    EXPECT_EQ(corners, (std::vector<float>{-0.1f, 0.0f, -0.1f, -0.1f, 0.0f, 0.1f, 0.1f, 0.0f, 0.1f, //
                                           -0.1f, 0.0f, -0.1f, 0.1f, 0.0f, 0.1f, 0.1f, 0.0f, -0.1f}));
    const std::vector<ts::Vector> path = press(2001);
    const ts::Ticks ticks = ts::touch(scene, path);
    EXPECT_EQ(ticks.contacts.front(), 0u);
    for (size_t i = 0; i < path.size(); ++i) {
        const double depth = std::max(0.0, -path[i][1]);
        EXPECT_NEAR(ticks.force[i][1], 800.0 * depth, 2e-4)
            << i; // a point stands 1e-6 of the object above it
        EXPECT_NEAR(ticks.proxy[i][1], std::max(0.0, path[i][1]), 2e-7);
    }
    EXPECT_GT(ticks.force.back()[1], 3.9);
    EXPECT_EQ(ticks.time[2000], 2.0);
}

/// A hand goes on where its last path ended.
TEST(OfflineTouch, GoesOnAlongASecondPath) {
    const ts::Scene scene({floorMesh()});
    const std::vector<ts::Vector> path = press(10'000);
    const ts::Ticks whole = ts::touch(scene, path);
    ts::Handle<ts_hand, ts_hand_close> hand;
    ts::check(ts_hand_create(scene.get(), nullptr, hand.out()));
    for (size_t begin = 0; begin < path.size(); begin += 3000) {
        ts::Ticks part(std::min<size_t>(3000, path.size() - begin));
        ts_path row = TS_STRUCT(ts_path);
        row.positions = path[begin].data();
        row.count = part.time.size();
        const ts_ticks arrays = part.arrays();
        size_t done = 0;
        ts::check(ts_hand_touch(hand.get(), &row, &arrays, &done));
        ASSERT_EQ(done, row.count);
        EXPECT_EQ(std::memcmp(part.force.data(), &whole.force[begin], done * sizeof(ts::Vector)), 0);
        EXPECT_EQ(std::memcmp(part.time.data(), &whole.time[begin], done * sizeof(double)), 0);
    }
}

/// Bits of the forces and proxies of the first `count` ticks.
bool sameTouch(const ts::Ticks& a, const ts::Ticks& b, size_t count) {
    return std::memcmp(a.force.data(), b.force.data(), count * sizeof(ts::Vector)) == 0 &&
           std::memcmp(a.proxy.data(), b.proxy.data(), count * sizeof(ts::Vector)) == 0;
}

/// Where nothing moves, each feels what it feels alone.
TEST(OfflineTouch, SeveralHandsFeelWhatEachFeelsAlone) {
    const ts::Scene scene(TOUCHSTONE_ASSETS "/doughnut.glb");
    std::vector<std::vector<ts::Vector>> paths;
    for (const char* stroke : {"circle", "tour", "circle"})
        paths.push_back(scene.stroke(stroke));
    for (std::vector<ts::Vector>& path : paths)
        path.resize(2000);
    const std::vector<ts::Ticks> together = ts::touch(scene, paths);
    ASSERT_EQ(together.size(), 3u);
    for (size_t hand = 0; hand < 3; ++hand) {
        const ts::Ticks alone = ts::touch(scene, paths[hand]);
        EXPECT_TRUE(sameTouch(together[hand], alone, 2000)) << hand;
        EXPECT_GT(std::ranges::count_if(alone.contacts, [](uint32_t contacts) { return contacts > 0; }), 500)
            << hand;
    }
}

/// What one hand pushes away the other does not find.
TEST(OfflineTouch, HandsFeelEachOtherThroughABody) {
    const ts::Scene scene(TOUCHSTONE_ASSETS "/cradle.glb");
    std::vector<ts::Vector> path = scene.stroke("tour");
    path.resize(3000);
    const std::vector<ts::Vector> far(path.size(), ts::Vector{0.5, 0.5, 0.5});
    const ts::Ticks alone = ts::touch(scene, path);
    ASSERT_GT(std::ranges::count_if(alone.contacts, [](uint32_t contacts) { return contacts > 0; }), 100);
    EXPECT_TRUE(sameTouch(ts::touch(scene, {path, far})[0], alone, path.size()));
    EXPECT_FALSE(sameTouch(ts::touch(scene, {path, path})[0], alone, path.size()));
}

/// The caller's rounding mode for denormals is his.
TEST(OfflineTouch, LeavesTheCallersFloatMode) {
    volatile double tiny = 1e-310;
    ASSERT_NE(tiny * 0.5, 0.0);
    (void)ts::touch(ts::Scene({floorMesh()}), press(100));
    EXPECT_NE(tiny * 0.5, 0.0);
}

TEST(OfflineTouch, ReadsWhatOtherProgramsWrote) {
    const ScratchFolder folder;
    writeTextFile(folder / "two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(ts::Scene((folder / "two.obj").string()).info().triangles, 1u) << "read by the helper process";
}

} // namespace
} // namespace touchstone::test

#include "engine/core/error.h"
#include "tests/support/program.h"
#include "workbench/files/chart_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <string_view>

namespace touchstone::chart_file_test {
namespace {

/// Two ticks in contact: 0.6 N along z, 0.2 N along x.
ForceHistory history() {
    ForceHistory history(10);
    for (int i = 0; i < 2; ++i) {
        TickRecord record;
        record.time = 3.0 + 0.5 * i;
        record.stepNs = 2000;
        record.output.contacts = 1;
        record.output.normal = record.output.planes[0] = {0.0, 0.0, 1.0};
        record.output.planeCount = 1;
        record.output.force = {0.2, 0.0, 0.6};
        record.output.penetration = 0.001;
        history.add(record, i == 1);
    }
    return history;
}

const ChartConditions kConditions{"it's.glb", "mouse", {}};

TEST(ChartFile, CsvKeepsItsColumnsAndAddsTheNewOnesAtTheEnd) {
    const test::ScratchFolder folder;
    writeChart(folder / "c.csv", history());
    std::istringstream lines(test::readFile(folder / "c.csv"));
    std::string head, first, second;
    std::getline(lines, head);
    std::getline(lines, first);
    std::getline(lines, second);
    EXPECT_EQ(head, "t,force,tangential,penetration,energy,step,contact,recorded,surface_normal,"
                    "surface_tangential,force_x,force_y,force_z");
    EXPECT_TRUE(first.starts_with("3.000000,0.632455")) << first;
    EXPECT_NE(first.find(",1,0,0.6"), std::string::npos) << first;
    EXPECT_NE(second.find(",1,1,0.6"), std::string::npos) << second;
    EXPECT_EQ(std::ranges::count(first, ','), std::ranges::count(head, ','));
}

TEST(ChartFile, FigureHasAPanelForTheForcesAndOneForEachOtherQuantity) {
    ShownQuantities shown{};
    for (size_t i = 0; i < shown.size(); ++i)
        shown[i] = std::string_view(chartQuantities()[i].name) != "energy";
    const study::Figure figure = chartFigure("charts-1", history(), shown, kConditions, {});
    const auto count = [&](const std::string& text) {
        size_t found = 0;
        for (size_t at = 0; (at = figure.script.find(text, at)) != std::string::npos; at += text.size())
            ++found;
        return found;
    };
    EXPECT_EQ(count("\nplot "), 3u) << "forces, depth, step";
    EXPECT_EQ(count("using 1:"), 8u);
    EXPECT_EQ(count("'force, N'"), 1u);
    EXPECT_EQ(count("'penetration depth, mm'"), 1u);
    EXPECT_EQ(count("time before the last tick, s"), 1u);
    EXPECT_EQ(count("title 'x'"), 1u);
    EXPECT_EQ(count("energy"), 0u);
    EXPECT_NE(figure.script.find("it''s.glb, mouse; when saved: shading material"), std::string::npos)
        << "a quote in a name does not end the string";
    std::istringstream rows(figure.data);
    std::string line;
    std::getline(rows, line);
    EXPECT_TRUE(line.starts_with("# time (s), normal force (N)")) << line;
    std::getline(rows, line);
    EXPECT_TRUE(line.starts_with("-0.500000 0.6 0.2")) << line;
    std::getline(rows, line);
    EXPECT_TRUE(line.starts_with("0.000000 ")) << line;
    EXPECT_TRUE(line.ends_with(" 1 2")) << "1 mm, 2 µs: " << line;
}

TEST(ChartFile, NothingToDrawIsSaid) {
    const auto figure = [](const ForceHistory& ticks, const ShownQuantities& shown) {
        return chartFigure("c", ticks, shown, kConditions, {});
    };
    EXPECT_THROW((void)figure(history(), {}), Error);
    EXPECT_THROW((void)figure(ForceHistory(4), kFirstQuantities), Error);
}

} // namespace
} // namespace touchstone::chart_file_test

#include "tests/stability/case_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <vector>

namespace touchstone::test {

namespace {

struct Row {
    std::string name, variant;
    Figures worst;
};

std::vector<Row>& rows() {
    static std::vector<Row> all;
    return all;
}

void keepWorse(Figure& worst, const Figure& run) {
    if (run.share() > worst.share() || (run.share() == worst.share() && run.allowed < worst.allowed))
        worst = run;
}

std::string cell(const Figure& figure, double unit) {
    char text[64];
    std::snprintf(text, sizeof text, "%.2g / %.2g", figure.measured / unit, figure.allowed / unit);
    return text;
}

/// Prints the table when the program ends, as Markdown: what was measured / what the geometry demands.
class CaseTable : public ::testing::Environment {
  public:
    void TearDown() override {
        if (rows().empty())
            return;
        std::printf("\nHard cases: measured / allowed by the geometry, in the run that came nearest to it\n\n"
                    "| case | variant | runs | ticks | passes, µm | NaN | sticks, µm | jitter, µN | jump, mN "
                    "| energy, µJ | late ticks, in a row, µm behind "
                    "|\n|---|---|---|---|---|---|---|---|---|---|---|\n");
        for (const Row& row : rows()) {
            const Figures& f = row.worst;
            std::printf("| %s | %s | %d | %d | %s | %.0f | %s | %s | %s | %s | %d, %d, %.2g |\n",
                        row.name.c_str(), row.variant.c_str(), f.runs, f.ticks, cell(f.passes, 1e-6).c_str(),
                        f.notFinite.measured, cell(f.sticks, 1e-6).c_str(), cell(f.jitter, 1e-6).c_str(),
                        cell(f.jump, 1e-3).c_str(), cell(f.energy, 1e-6).c_str(), f.late, f.lateInARow,
                        f.behind / 1e-6);
        }
    }
};

[[maybe_unused]] const auto* const kTable = ::testing::AddGlobalTestEnvironment(new CaseTable);

} // namespace

void addToCaseTable(const std::string& name, const std::string& variant, const Figures& figures) {
    Row* row = nullptr;
    for (Row& known : rows())
        if (known.name == name && known.variant == variant)
            row = &known;
    if (row == nullptr) {
        rows().push_back({name, variant, figures});
        return;
    }
    Figures& worst = row->worst;
    keepWorse(worst.passes, figures.passes);
    worst.notFinite.measured += figures.notFinite.measured;
    keepWorse(worst.sticks, figures.sticks);
    keepWorse(worst.jitter, figures.jitter);
    keepWorse(worst.jump, figures.jump);
    keepWorse(worst.energy, figures.energy);
    worst.runs += figures.runs;
    worst.ticks += figures.ticks;
    worst.late += figures.late;
    worst.lateInARow = std::max(worst.lateInARow, figures.lateInARow);
    worst.behind = std::max(worst.behind, figures.behind);
    worst.notConverged += figures.notConverged;
}

} // namespace touchstone::test

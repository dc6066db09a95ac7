#include "workbench/files/chart_file.h"

#include "engine/core/error.h"
#include "engine/core/output_file.h"
#include "engine/time/seconds_now.h"
#include "study/report/plots/gnuplot.h"
#include "study/result/provenance.h"
#include "workbench/files/stacked_figure.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <exception>
#include <utility>
#include <vector>

namespace touchstone {

namespace {

/// Quantities that share a panel, by index.
using Panel = std::vector<size_t>;

std::vector<Panel> panelsOf(const ShownQuantities& shown) {
    std::vector<Panel> panels;
    bool forces = false; // the first panel has them
    for (size_t i = 0; i < shown.size(); ++i) {
        if (!shown[i])
            continue;
        const bool force = std::string_view(chartQuantities()[i].symbol) == "N";
        if (force && forces)
            panels.front().push_back(i);
        else
            panels.push_back({i});
        forces = forces || force;
    }
    return panels;
}

/// Columns: seconds before the last tick, then the shown quantities in their units.
std::string dataOf(const ForceHistory& history, const ShownQuantities& shown) {
    std::string data = "# time (s)";
    for (size_t i = 0; i < shown.size(); ++i)
        if (shown[i])
            data += std::string(", ") + chartQuantities()[i].words + " (" + chartQuantities()[i].symbol + ")";
    data += "\n";
    std::array<char, 32> text{};
    const double last = history.at(history.size() - 1).time;
    for (size_t t = 0; t < history.size(); ++t) {
        const ForceHistory::Entry& entry = history.at(t);
        std::snprintf(text.data(), text.size(), "%.6f", entry.time - last);
        data += text.data();
        for (size_t i = 0; i < shown.size(); ++i) {
            if (!shown[i])
                continue;
            const ChartQuantity& quantity = chartQuantities()[i];
            std::snprintf(text.data(), text.size(), " %.6g",
                          static_cast<double>(entry.*quantity.value) / quantity.unit);
            data += text.data();
        }
        data += "\n";
    }
    return data;
}

/// The column of a quantity in the data, from 1; time is the first.
size_t columnOf(size_t quantity, const ShownQuantities& shown) {
    return 2 + static_cast<size_t>(
                   std::count(shown.begin(), shown.begin() + static_cast<std::ptrdiff_t>(quantity), true));
}

/// Where all values are of one sign the axis begins at zero; a flat curve gets some height.
StackedPanel panelOf(const Panel& quantities, const ForceHistory& history, const ShownQuantities& shown) {
    const ChartQuantity& first = chartQuantities()[quantities.front()];
    const bool several = quantities.size() > 1;
    StackedPanel panel{.axis = std::string(several ? "force" : first.words) + ", " + first.symbol,
                       .low = 0.0,
                       .high = 0.0,
                       .curves = {}};
    for (const size_t i : quantities) {
        const ChartQuantity& quantity = chartQuantities()[i];
        panel.high = std::max(panel.high, quantity.minEnd);
        panel.low = quantity.positive ? panel.low : std::min(panel.low, -quantity.minEnd);
        for (size_t t = 0; t < history.size(); ++t) {
            const double value = static_cast<double>(history.at(t).*quantity.value) / quantity.unit;
            panel.low = std::min(panel.low, value);
            panel.high = std::max(panel.high, value);
        }
        panel.curves.push_back(
            {.title = several ? quantity.name : quantity.words, .column = columnOf(i, shown), .mark = i});
    }
    panel.low *= 1.05;
    panel.high *= 1.08;
    return panel;
}

std::string conditionsText(const ChartConditions& conditions) {
    const auto setting = [&](const char* name) { return settingValue(conditions.settings, name); };
    return conditions.model + ", " + conditions.hand + "; when saved: shading " + setting("forceShading") +
           ", texture " + setting("texture") + ", friction " + setting("friction");
}

} // namespace

void writeChart(const std::filesystem::path& file, const ForceHistory& history) {
    std::string text = "t,force,tangential,penetration,energy,step,contact,recorded,surface_normal,"
                       "surface_tangential,force_x,force_y,force_z\n";
    std::array<char, 320> row{};
    for (size_t i = 0; i < history.size(); ++i) {
        const ForceHistory::Entry& e = history.at(i);
        const auto number = [](float value) { return static_cast<double>(value); };
        std::snprintf(row.data(), row.size(),
                      "%.6f,%.9g,%.9g,%.9g,%.9g,%.9g,%d,%d,%.9g,%.9g,%.9g,%.9g,%.9g\n", e.time,
                      number(e.force), number(e.tangential), number(e.penetration), number(e.energy),
                      number(e.step), e.contact ? 1 : 0, e.recorded ? 1 : 0, number(e.normal),
                      number(e.surfaceTangential), number(e.x), number(e.y), number(e.z));
        text += row.data();
    }
    writeFile(file, text);
}

study::Figure chartFigure(const std::string& name, const ForceHistory& history, const ShownQuantities& shown,
                          const ChartConditions& conditions, const study::Provenance& where) {
    const std::vector<Panel> panels = panelsOf(shown);
    if (panels.empty() || history.size() < 2)
        throw Error("charts", "", panels.empty() ? "no quantity is shown" : "there are no ticks yet",
                    panels.empty() ? "choose one under Strips" : "wait until the servo runs");
    StackedFigure figure{.name = name,
                         .title = "What is felt, over time",
                         .subtitle = conditionsText(conditions),
                         .timeAxis = "time before the last tick, s",
                         .begin = history.at(0).time - history.at(history.size() - 1).time,
                         .end = 0.0,
                         .panels = {},
                         .data = dataOf(history, shown)};
    for (const Panel& panel : panels)
        figure.panels.push_back(panelOf(panel, history, shown));
    return stacked(std::move(figure), where);
}

void ChartSaver::saveCsv(const ForceHistory& history) {
    note_ = {.file = {}, .problem = {}, .at = secondsNow()};
    try {
        const std::filesystem::path file = savedFile("charts", ".csv");
        writeChart(file, history);
        note_.file = file;
    } catch (const std::exception& error) {
        note_.problem = error.what();
    }
}

void ChartSaver::saveFigure(const ForceHistory& history, const ShownQuantities& shown,
                            const ChartConditions& conditions) {
    if (busy())
        return;
    drawing_ = std::async(std::launch::async, [history, shown, conditions]() -> SavedNote {
        SavedNote note;
        try {
            const std::filesystem::path file = savedFile("charts", ".svg");
            const study::Figure figure =
                chartFigure(file.stem().string(), history, shown, conditions, study::provenanceOf("window"));
            note.problem = study::draw(figure, file.parent_path());
            if (note.problem.empty())
                note.file = file;
        } catch (const std::exception& error) {
            note.problem = error.what();
        }
        note.at = secondsNow();
        return note;
    });
}

void ChartSaver::update() {
    if (drawing_.valid() && drawing_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
        note_ = drawing_.get();
}

} // namespace touchstone

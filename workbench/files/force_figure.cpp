#include "workbench/files/force_figure.h"

#include "engine/core/error.h"
#include "study/report/plots/gnuplot.h"
#include "study/result/provenance.h"
#include "workbench/files/stacked_figure.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

namespace touchstone {

namespace {

constexpr size_t kIntervals = 1500; // over the figure's width

void append(std::string& text, const char* format, double value) {
    std::array<char, 32> number{};
    std::snprintf(number.data(), number.size(), format, value);
    text += number.data();
}

} // namespace

ForceFigure::ForceFigure(std::vector<std::string> titles) {
    for (std::string& title : titles)
        touches_.push_back({std::move(title), {}, {}});
}

void ForceFigure::begin(double seconds, double force, double depth) {
    seconds_.push_back(seconds);
    next_ = 0;
    add(force, depth);
}

void ForceFigure::add(double force, double depth) {
    constexpr double kMillimetres = 1000.0;
    Touch& touch = touches_.at(next_++);
    touch.force.push_back(static_cast<float>(force));
    touch.depth.push_back(static_cast<float>(kMillimetres * depth));
}

/// Of an interval of several ticks two rows: the least of each column, then the most.
std::string ForceFigure::data() const {
    std::string text = "# time (s), then force (N) and depth (mm) of each touch\n";
    const size_t ticks = seconds_.size(), rows = std::min(ticks, kIntervals);
    for (size_t row = 0; row < rows; ++row) {
        const size_t from = row * ticks / rows, to = (row + 1) * ticks / rows;
        const std::array<size_t, 2> times{from, to - 1};
        for (size_t end = 0; end < (to - from > 1 ? 2u : 1u); ++end) {
            append(text, "%.6f", seconds_[times[end]]);
            for (const Touch& touch : touches_)
                for (const std::vector<float>* values : {&touch.force, &touch.depth}) {
                    const auto [least, most] =
                        std::minmax_element(values->begin() + static_cast<ptrdiff_t>(from),
                                            values->begin() + static_cast<ptrdiff_t>(to));
                    append(text, " %.6g", static_cast<double>(end == 0 ? *least : *most));
                }
            text += "\n";
        }
    }
    return text;
}

void ForceFigure::draw(const std::filesystem::path& file, const std::string& subtitle) const {
    if (seconds_.size() < 2)
        throw Error(file.string(), "", "not drawn: fewer than two ticks can be touched again", "");
    StackedFigure figure{.name = file.stem().string(),
                         .title = "What was felt, over time",
                         .subtitle = subtitle,
                         .timeAxis = "time, s",
                         .begin = seconds_.front(),
                         .end = std::max(seconds_.back(), seconds_.front() + 1e-3),
                         .panels = {{.axis = "force, N", .curves = {}}, {.axis = "depth, mm", .curves = {}}},
                         .data = data()};
    for (size_t i = 0; i < touches_.size(); ++i)
        for (size_t p = 0; p < figure.panels.size(); ++p) {
            const std::vector<float>& values = p == 0 ? touches_[i].force : touches_[i].depth;
            StackedPanel& panel = figure.panels[p];
            const double most = static_cast<double>(std::ranges::max(values));
            panel.high = std::max({i == 0 ? 0.1 : panel.high, 1.08 * most});
            panel.curves.push_back(
                {.title = p == 0 ? touches_[i].title : "", .column = 2 + 2 * i + p, .mark = i});
        }
    const std::string problem = // "FILE: why"
        study::draw(stacked(std::move(figure), study::provenanceOf("replay")), file.parent_path(), "gnuplot",
                    file.extension() == ".png" ? study::PlotFormat::Png : study::PlotFormat::Svg);
    if (!problem.empty())
        throw Error(file.string(), "", problem.substr(std::min(problem.find(": ") + 2, problem.size())), "");
}

} // namespace touchstone

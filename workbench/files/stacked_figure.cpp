#include "workbench/files/stacked_figure.h"

#include <array>
#include <cstdio>
#include <utility>

namespace touchstone {

namespace {

constexpr double kPanelHeight = 180.0, kPanelGap = 52.0; // pixels of the page
constexpr double kHead = 90.0, kFoot = 92.0;

std::string rangeOf(char axis, int digits, double low, double high) {
    std::array<char, 128> text{};
    std::snprintf(text.data(), text.size(), "set %crange [%.*g:%.*g]\n", axis, digits, low, digits, high);
    return text.data();
}

std::string curvesOf(const StackedPanel& panel, const std::string& name) {
    std::string script = "plot ";
    std::array<char, 96> line{};
    for (const StackedCurve& curve : panel.curves) {
        std::snprintf(line.data(), line.size(), " using 1:%zu with lines lw 1.2 lc rgb '%s' title ",
                      curve.column, std::string(study::markOf(curve.mark).colour).c_str());
        script += (&curve != &panel.curves.front() ? ", " : "") + study::inQuotes("./" + name + ".dat") +
                  line.data() + study::inQuotes(curve.title);
    }
    return script + "\n";
}

} // namespace

study::Figure stacked(StackedFigure figure, const study::Provenance& where) {
    study::Paper paper;
    paper.width = 960.0;
    paper.height = kHead + kFoot + static_cast<double>(figure.panels.size()) * (kPanelHeight + kPanelGap);
    paper.area = {90.0, paper.width - 30.0, 0.0, 0.0};
    paper.title = std::move(figure.title);
    paper.subtitle = std::move(figure.subtitle);
    study::Figure drawn{.name = figure.name, .script = {}, .data = std::move(figure.data)};
    std::array<char, 160> margins{};
    for (size_t p = 0; p < figure.panels.size(); ++p) {
        const StackedPanel& panel = figure.panels[p];
        paper.area.top = paper.height - kHead - static_cast<double>(p) * (kPanelHeight + kPanelGap) - 24.0;
        paper.area.bottom = paper.area.top - kPanelHeight;
        drawn.script +=
            p == 0 ? study::openPaper(figure.name, paper, where) + "set multiplot\n" : "unset label\n";
        std::snprintf(margins.data(), margins.size(),
                      "set tmargin at screen %.6f\nset bmargin at screen %.6f\n",
                      paper.area.top / paper.height, paper.area.bottom / paper.height);
        drawn.script += margins.data() + rangeOf('x', 9, figure.begin, figure.end) +
                        "set key at graph 1,1.03 right bottom horizontal maxrows 1 samplen 2 spacing 1.2\n" +
                        rangeOf('y', 6, panel.low, panel.high) + "set ylabel " + study::inQuotes(panel.axis) +
                        " offset 0.5,0\n" +
                        (p + 1 == figure.panels.size()
                             ? "set format x '%g'\nset xlabel " + study::inQuotes(figure.timeAxis) + "\n"
                             : "set format x ''\n") +
                        curvesOf(panel, figure.name);
    }
    drawn.script += "unset multiplot\n";
    return drawn;
}

} // namespace touchstone

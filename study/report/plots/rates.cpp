#include "study/report/plots/figures.h"

#include <algorithm>
#include <cstdio>

namespace touchstone::study {

namespace {

std::string line(const char* format, const auto&... values) {
    std::array<char, 320> text{};
    std::snprintf(text.data(), text.size(), format, values...);
    return text.data();
}

} // namespace

std::vector<Figure> stabilityOverRate(const StudyResult& result) {
    if (result.rates.size() < 2)
        return {};
    Figure figure;
    figure.name = "servo_rate";
    std::vector<double> rates, stiffnesses;
    double most = 0.0;
    for (const RateResult& r : result.rates) {
        rates.push_back(1e-3 * r.rateHz);
        stiffnesses.insert(stiffnesses.end(), {1e-3 * r.stiffestStable, 1e-3 * r.bound});
        most = std::max(most, 100.0 * r.busy.high);
        figure.data += line("%.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", 1e-3 * r.rateHz, 1e-3 * r.stiffestStable,
                            1e-3 * r.bound, 1e3 * r.energyCreated, 100.0 * r.busy.value, 100.0 * r.busy.low,
                            100.0 * r.busy.high);
    }
    figure.data =
        "# rate (kHz), stiffest stable wall, bound (N/mm), energy (mJ), processor, low, high (%)\n" +
        figure.data;
    Paper paper;
    paper.width = 1180.0;
    paper.height = 620.0;
    paper.area = {90.0, 560.0, 105.0, 520.0};
    paper.title = "What a faster servo buys, and what it costs";
    paper.subtitle = "Left: a device of 75 g and 1 N·s/m pressed against a wall, in closed loop through the "
                     "whole haptic step. "
                     "Right: a stroke over a torus of 64,800 triangles.";
    figure.script = openPaper(figure.name, paper, result.provenance);
    const LogAxis x = LogAxis::around(rates), y = LogAxis::around(stiffnesses);
    const std::string file = "'servo_rate.dat'";
    figure.script +=
        "set multiplot\n" + x.script('x') + y.script('y') +
        "set xlabel 'servo rate, kHz'\nset ylabel 'stiffness of the wall, N/mm'\n"
        "set key top left reverse Left samplen 2 spacing 1.3\n"
        "plot " +
        file + " using 1:3 with lines dt (8,5) lw 1.6 lc rgb '#a00000' title 'bound from theory, 2b/T', " +
        file +
        " using 1:2 with points pt 7 ps 0.9 lc rgb '#0072b2' title 'stiffest that comes to rest, "
        "measured'\n"
        "unset label\nset lmargin at screen 0.58\nset rmargin at screen 0.97\n"
        "unset logscale y\nset ytics auto\n" +
        line("set yrange [0:%.6g]\n", std::max(1e-3, 1.15 * most)) +
        "set ylabel 'share of one processor, %'\n"
        "plot " +
        file + " using 1:5:6:7 with yerrorbars pt 0 lw 1 lc rgb '#d55e00' notitle, " + file +
        " using 1:5 with linespoints pt 5 ps 0.9 lw 1.6 lc rgb '#d55e00' title 'median of the strokes; bar: "
        "95 % interval'\n"
        "unset multiplot\n";
    return {figure};
}

} // namespace touchstone::study

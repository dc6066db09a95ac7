#include "study/report/plots/figure.h"

#include "study/subject/subject.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace touchstone::study {

namespace {

std::string number(double value) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.10g", value);
    return text.data();
}

/// Axis label: 10,000 and 0.00001.
std::string ticText(double value) {
    if (value >= 1e4)
        return grouped(static_cast<size_t>(std::lround(value)));
    std::array<char, 40> text{};
    if (value < 1e-4 && value > 1e-12)
        std::snprintf(text.data(), text.size(), "%.*f",
                      static_cast<int>(std::ceil(-std::log10(value) - 1e-9)), value);
    return text[0] != '\0' ? text.data() : number(value);
}

/// The largest of 1, 2, 5 times a power of ten not above `value`.
double stepBelow(double value) {
    const double decade = std::pow(10.0, std::floor(std::log10(value) + 1e-9));
    for (const double step : {5.0, 2.0})
        if (step * decade <= value * (1.0 + 1e-9))
            return step * decade;
    return decade;
}
double stepAbove(double value) {
    const double below = stepBelow(value);
    if (below >= value * (1.0 - 1e-9))
        return below;
    const double lead = below / std::pow(10.0, std::floor(std::log10(below) + 1e-9));
    return below * (lead > 1.5 && lead < 3.0 ? 2.5 : 2.0);
}

} // namespace

Mark markOf(size_t series) {
    static constexpr std::array<Mark, 8> kMarks{{{"#0072b2", 7},
                                                 {"#d55e00", 5},
                                                 {"#009e73", 9},
                                                 {"#b0498c", 13},
                                                 {"#e69f00", 11},
                                                 {"#56b4e9", 15},
                                                 {"#222222", 6},
                                                 {"#8c6d31", 4}}};
    // From the ninth series on each colour gets another shape.
    return {kMarks[series % kMarks.size()].colour,
            kMarks[(series + series / kMarks.size()) % kMarks.size()].point};
}

std::string inQuotes(std::string_view text) {
    std::string result = "'";
    for (const char c : text) {
        if (c == '\'')
            result += "''";
        else
            result += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
    }
    return result + "'";
}

std::string slug(std::string_view text) {
    std::string result;
    for (const char c : text) {
        const bool keep = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
        if (keep)
            result += c;
        else if (c >= 'A' && c <= 'Z')
            result += static_cast<char>(c - 'A' + 'a');
        else if (c != ',' && !result.empty() && result.back() != '_')
            result += '_';
    }
    result.resize(std::min<size_t>(result.size(), 60));
    while (!result.empty() && result.back() == '_')
        result.pop_back();
    return result;
}

std::string brief(double value) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), std::abs(value) >= 1000.0 ? "%.0f" : "%.3g", value);
    return text.data();
}

std::string cut(std::string_view text, size_t most) {
    size_t letters = 0;
    for (size_t i = 0; i < text.size(); ++i) {
        const bool begins = (static_cast<unsigned char>(text[i]) & 0xc0) != 0x80;
        if (begins && letters++ == most)
            return std::string(text.substr(0, i)) + "…";
    }
    return std::string(text);
}

double textWidth(std::string_view text, double size) {
    const auto letters = std::count_if(text.begin(), text.end(),
                                       [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; });
    return 0.6 * size * static_cast<double>(letters);
}

std::string labelAt(const Paper& paper, double x, double y, std::string_view text, std::string_view style,
                    double size) {
    return "set label " + inQuotes(text) + " at screen " + number(x / paper.width) + "," +
           number(y / paper.height) + " font '," + number(size) + "' " + std::string(style) + " front\n";
}

std::string markAt(const Paper& paper, double x, double y, const Mark& mark) {
    return "set label '' at screen " + number(x / paper.width) + "," + number(y / paper.height) +
           " point pt " + std::to_string(mark.point) + " ps 0.8 lc rgb '" + std::string(mark.colour) +
           "' front\n";
}

std::string openPaper(const std::string& name, const Paper& paper, const Provenance& where) {
    std::string script = "# gnuplot " + inQuotes(name + ".gp") +
                         " draws this again.\n"
                         "if (!exists('out')) out = " +
                         inQuotes("./" + name + ".svg") + "\n" +
                         "if (exists('png')) {\n  set terminal pngcairo size " + number(paper.width) +
                         "*png," + number(paper.height) +
                         "*png noenhanced font 'Inter,13' fontscale png linewidth png pointscale png "
                         "background '#ffffff'\n} else {\n  set terminal svg size " +
                         number(paper.width) + "," + number(paper.height) +
                         " dynamic noenhanced font 'Inter,13' background '#ffffff' linewidth 1\n}\n"
                         "set output out\n"
                         "set encoding utf8\n"
                         "set lmargin at screen " +
                         number(paper.area.left / paper.width) + "\nset rmargin at screen " +
                         number(paper.area.right / paper.width) + "\nset bmargin at screen " +
                         number(paper.area.bottom / paper.height) + "\nset tmargin at screen " +
                         number(paper.area.top / paper.height) +
                         "\nset border 3 lc rgb '#555555'\n"
                         "set tics nomirror textcolor rgb '#333333'\n"
                         "set grid xtics ytics lc rgb '#e4e4e4' lw 1 dt 1\n"
                         "unset key\n";
    script += labelAt(paper, 20.0, paper.height - 26.0, paper.title, "", 17.0);
    script += labelAt(paper, 20.0, paper.height - 50.0, paper.subtitle, "tc rgb '#555555'", 12.5);
    std::vector<std::string> foot = paper.notes;
    std::string measured = where.processor;
    for (const std::string& part :
         {where.compiler, where.buildType, where.commit.empty() ? "" : "commit " + where.commit, where.date})
        if (!part.empty())
            measured += (measured.empty() ? "" : ", ") + part;
    if (!measured.empty())
        foot.push_back("Measured on " + measured);
    for (size_t i = 0; i < foot.size(); ++i)
        script += labelAt(paper, 20.0, 14.0 + 15.0 * static_cast<double>(foot.size() - 1 - i),
                          cut(foot[i], static_cast<size_t>(paper.width / 5.6)), "tc rgb '#777777'", 10.0);
    return script;
}

LogAxis LogAxis::around(const std::vector<double>& values, double minLow) {
    double low = INFINITY, high = 0.0;
    for (const double value : values)
        if (std::isfinite(value) && value > 0.0 && value >= minLow) {
            low = std::min(low, value);
            high = std::max(high, value);
        }
    LogAxis axis;
    if (!(high > 0.0))
        low = high = minLow > 0.0 ? minLow : 1.0;
    axis.low = stepBelow(low / 1.08);
    axis.high = stepAbove(high * 1.08);
    while (axis.high < 3.1 * axis.low)
        axis.high = stepAbove(axis.high * 1.01);
    return axis;
}

double LogAxis::bottom() const {
    // A tenth of the axis, regardless of its number of decades.
    return band ? low * std::pow(high / low, -0.1) : low;
}

double LogAxis::place(double value) const {
    return !(value >= low) && band ? std::sqrt(low * bottom()) : std::clamp(value, low, high);
}

double LogAxis::fraction(double value) const {
    return std::log(value / bottom()) / std::log(high / bottom());
}

std::string LogAxis::script(char axis) const {
    const double decades = std::log10(high / low);
    std::vector<double> steps{1.0};
    if (decades <= 1.2)
        steps = {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0};
    else if (decades <= 3.2)
        steps = {1.0, 2.0, 5.0};
    std::string tics =
        bandTic.empty() || !band ? "" : inQuotes(bandTic) + " " + number(std::sqrt(low * bottom())) + ", ";
    for (double decade = std::floor(std::log10(low) - 1e-9); decade <= std::ceil(std::log10(high)); ++decade)
        for (const double step : steps) {
            const double at = step * std::pow(10.0, decade);
            if (at >= low * (1.0 - 1e-9) && at <= high * (1.0 + 1e-9))
                tics += inQuotes(ticText(at)) + " " + number(at) + ", ";
        }
    if (tics.ends_with(", "))
        tics.resize(tics.size() - 2);
    const std::string name(1, axis);
    return "set logscale " + name + "\nset " + name + "range [" + number(bottom()) + ":" + number(high) +
           "]\nset " + name + "tics (" + tics + ")\n";
}

} // namespace touchstone::study

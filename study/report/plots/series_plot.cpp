#include "study/report/plots/series_plot.h"

#include <algorithm>
#include <cstdio>

namespace touchstone::study {

namespace {

constexpr std::string_view kFloorColour = "#888888";

size_t indexOf(std::vector<std::string>& names, const std::string& name) {
    auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end())
        at = names.insert(names.end(), name);
    return static_cast<size_t>(at - names.begin());
}

class Drawing {
  public:
    Drawing(SeriesPlot& plot, const Provenance& where) : plot_(plot), where_(where) {
        std::erase_if(plot_.series, [](const Series& s) { return s.points.empty(); });
        for (Series& s : plot_.series) {
            std::sort(s.points.begin(), s.points.end(),
                      [](const SeriesPoint& a, const SeriesPoint& b) { return a.x < b.x; });
            if (!s.floor)
                (void)indexOf(colours_, s.colourName);
            (void)indexOf(marks_, s.markName);
        }
        oneKey_ = std::all_of(plot_.series.begin(), plot_.series.end(),
                              [](const Series& s) { return s.floor || s.colourName == s.markName; });
        std::sort(plot_.thresholds.begin(), plot_.thresholds.end(),
                  [](const Threshold& a, const Threshold& b) { return a.at < b.at; });
        chooseAxes();
    }

    [[nodiscard]] Figure figure() const {
        Figure figure;
        if (plot_.series.empty())
            return figure;
        figure.name = plot_.name;
        figure.script = openPaper(figure.name, plot_.paper, where_) + x_.script('x') + y_.script('y') +
                        "set xlabel " + inQuotes(plot_.xWords) + "\nset ylabel " + inQuotes(plot_.yWords) +
                        " offset 0.5,0\n" + band() + thresholds() + key() + curves();
        figure.data = data();
        return figure;
    }

  private:
    void chooseAxes() {
        std::vector<double> xs, ys;
        bool exact = false;
        for (const Series& s : plot_.series)
            for (const SeriesPoint& p : s.points) {
                xs.push_back(p.x);
                for (const double y : {p.low, p.y, p.high})
                    ys.push_back(y);
                exact = exact || !(p.y >= plot_.minY) || !(p.y > 0.0);
            }
        for (const Threshold& t : plot_.thresholds)
            xs.push_back(t.at);
        x_ = LogAxis::around(xs);
        y_ = LogAxis::around(ys, plot_.minY);
        y_.band = exact;
        y_.bandTic = "exact";
    }
    [[nodiscard]] Mark markFor(const Series& s) const {
        auto colours = colours_, marks = marks_;
        Mark mark = markOf(s.floor ? 0 : indexOf(colours, s.colourName));
        mark.point = markOf(indexOf(marks, s.markName)).point;
        if (s.floor)
            mark.colour = kFloorColour;
        return mark;
    }
    [[nodiscard]] std::string at(double x, double y) const {
        std::array<char, 64> text{};
        std::snprintf(text.data(), text.size(), "%.6f,%.6f", x / plot_.paper.width, y / plot_.paper.height);
        return text.data();
    }
    [[nodiscard]] std::string band() const {
        if (!y_.band)
            return "";
        return "set object rectangle from graph 0,0 to graph 1, first " + std::to_string(y_.low) +
               " fc rgb '#f2f2f2' fs solid noborder behind\n" +
               labelAt(plot_.paper, plot_.paper.area.right - 6.0, plot_.paper.area.bottom + 10.0,
                       plot_.leastText, "right tc rgb '#777777'", 10.5);
    }
    /// A name above each, in a second row where two are close together.
    [[nodiscard]] std::string thresholds() const {
        std::string script;
        const Area& a = plot_.paper.area;
        double end[2]{-1.0, -1.0}; // end of the names in each row
        for (const Threshold& t : plot_.thresholds) {
            const double x = a.left + x_.fraction(t.at) * (a.right - a.left);
            const double half = 0.5 * textWidth(t.name, 11.0);
            const int row = x - half > end[0] ? 0 : 1;
            end[row] = x + half + 4.0;
            script += "set arrow from screen " + at(x, a.bottom) + " to screen " +
                      at(x, a.top + 4.0 + 14.0 * row) + " nohead dt (8,5) lw 1.4 lc rgb '#a00000' back\n";
            script +=
                labelAt(plot_.paper, x, a.top + 11.0 + 14.0 * row, t.name, "center tc rgb '#a00000'", 11.0);
        }
        return script;
    }
    [[nodiscard]] std::string key() const {
        const double left = plot_.paper.area.right + 30.0;
        double y = plot_.paper.area.top - 4.0;
        std::string script;
        const auto line = [&](const std::string& colour, const std::string& style, const std::string& text) {
            script += "set arrow from screen " + at(left - 4.0, y) + " to screen " + at(left + 18.0, y) +
                      " nohead lw 2.2 " + style + " lc rgb '" + colour + "' front\n" +
                      labelAt(plot_.paper, left + 26.0, y, cut(text, 44), "", 12.0);
            y -= 19.0;
        };
        const auto title = [&](const std::string& text) {
            if (text.empty())
                return;
            script += labelAt(plot_.paper, left - 4.0, y, text, "tc rgb '#555555'", 12.0);
            y -= 19.0;
        };
        title(plot_.colourTitle);
        for (size_t i = 0; i < colours_.size(); ++i)
            if (oneKey_) {
                script += markAt(plot_.paper, left + 7.0, y, markOf(i)) +
                          labelAt(plot_.paper, left + 26.0, y, cut(colours_[i], 44), "", 12.0);
                y -= 19.0;
            } else {
                line(std::string(markOf(i).colour), "", colours_[i]);
            }
        for (const Series& s : plot_.series)
            if (s.floor) {
                line(std::string(kFloorColour), "dt (4,4)", s.colourName);
                break;
            }
        y -= 8.0;
        if (marks_.size() > 1 && !oneKey_) {
            title(plot_.markTitle);
            keyOfMarks(script, left, y);
        }
        if (plot_.thresholds.empty())
            return script;
        y -= 8.0;
        title(plot_.thresholdTitle);
        for (const Threshold& t : plot_.thresholds) {
            script += labelAt(plot_.paper, left - 4.0, y, t.name, "tc rgb '#a00000'", 12.0) +
                      labelAt(plot_.paper, left + 58.0, y, cut(t.text, 48), "", 12.0);
            y -= 19.0;
        }
        return script;
    }
    void keyOfMarks(std::string& script, double left, double& y) const {
        for (size_t i = 0; i < marks_.size(); ++i) {
            Mark mark = markOf(i);
            mark.colour = "#333333";
            script += markAt(plot_.paper, left + 7.0, y, mark) +
                      labelAt(plot_.paper, left + 26.0, y, cut(marks_[i], 44), "", 12.0);
            y -= 19.0;
        }
    }
    [[nodiscard]] std::string curves() const {
        std::string script = "plot ";
        for (size_t i = 0; i < plot_.series.size(); ++i) {
            const Series& s = plot_.series[i];
            const Mark mark = markFor(s);
            const std::string file = "'" + plot_.name + ".dat' index " + std::to_string(i),
                              colour = " lc rgb '" + std::string(mark.colour) + "'";
            script += (i > 0 ? ", \\\n  " : "") + file + " using 1:2 with lines lw 1.5" +
                      (s.floor ? " dt (4,4)" : "") + colour + ", \\\n  " + file +
                      " using 1:2:3:4 with yerrorbars pt 0 lw 1" + colour + ", \\\n  " + file +
                      " using 1:2 with points pt " + std::to_string(mark.point) + " ps 0.8" + colour;
        }
        return script + "\n";
    }
    [[nodiscard]] std::string data() const {
        std::string text;
        for (const Series& s : plot_.series) {
            text += "# " + slug(s.colourName) + ", " + slug(s.markName) + ": x, y as drawn, low, high, y\n";
            for (const SeriesPoint& p : s.points) {
                std::array<char, 160> line{};
                std::snprintf(line.data(), line.size(), "%.9g %.9g %.9g %.9g %.9g\n", p.x, y_.place(p.y),
                              y_.place(p.low), y_.place(p.high), p.y);
                text += line.data();
            }
            text += "\n\n";
        }
        return text;
    }

    SeriesPlot& plot_;
    const Provenance& where_;
    std::vector<std::string> colours_, marks_;
    LogAxis x_, y_;
    bool oneKey_ = false;
};

} // namespace

Figure figureOf(SeriesPlot plot, const Provenance& where) {
    return Drawing(plot, where).figure();
}

} // namespace touchstone::study

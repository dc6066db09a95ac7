#include "study/pareto.h"
#include "study/report/plots/figures.h"
#include "study/report/plots/label_places.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace touchstone::study {

namespace {

/// A plotted error: the 99th percentile of one of the spreads.
struct Quantity {
    std::string_view name, title, unit;
    double inUnit; ///< of the plot, for one SI unit
    double floor;  ///< in the plot's unit; smaller values are drawn as exact
    Spread Errors::*spread;
    std::string_view noticeable; ///< JustNoticeable::quantity
};
constexpr std::array<Quantity, 3> kQuantities{{
    {"force", "Force", "mN", 1e3, 1e-3, &Errors::force, "force"},
    {"position", "Place of the proxy", "µm", 1e6, 1e-3, &Errors::position, "position"},
    {"direction", "Direction of the force", "degrees", 180.0 / std::numbers::pi, 1e-4,
     &Errors::forceDirection, "force direction"},
}};

/// By Truth.
constexpr std::array<std::string_view, 4> kAgainst{"the shape in closed form", "the mesh solved exactly",
                                                   "its most exact configuration", "Coulomb's law"};

struct Point {
    const ConfigurationResult* configuration;
    double error;    ///< of the plot's unit
    size_t ablation; ///< series
    bool front = false;
    int number = 0; ///< in the legend; 0: none
};

/// For this quantity: study/pareto marks the fronts of the force.
void markFront(std::vector<Point>& points) {
    for (Point& p : points)
        p.front = std::none_of(points.begin(), points.end(), [&](const Point& other) {
            return other.ablation == p.ablation && other.configuration->truth == p.configuration->truth &&
                   other.configuration->rateHz == p.configuration->rateHz &&
                   beats(other.configuration->step, other.error, p.configuration->step, p.error);
        });
}

class ErrorPlot {
  public:
    ErrorPlot(const SceneRungs& scene, const Quantity& quantity, const StudyResult& result)
        : scene_(scene), quantity_(quantity), result_(result) {
        for (const ConfigurationResult* configuration : scene.configurations)
            if (configuration->errors.compared > 0 && configuration->step.value > 0.0) {
                auto at = std::find(ablations_.begin(), ablations_.end(), configuration->ablation);
                if (at == ablations_.end())
                    at = ablations_.insert(ablations_.end(), configuration->ablation);
                points_.push_back({configuration,
                                   quantity.inUnit * (configuration->errors.*quantity.spread).p99,
                                   static_cast<size_t>(at - ablations_.begin())});
            }
        for (const JustNoticeable& j : result.noticeable)
            if (j.quantity == quantity.noticeable && j.value > 0.0)
                noticeable_ = &j;
        markFront(points_);
        number();
        makeRoom();
        chooseAxes();
    }

    [[nodiscard]] bool empty() const { return points_.empty(); }

    [[nodiscard]] Figure figure() {
        Figure figure;
        figure.name = "error_" + std::string(quantity_.name) + "_" + scene_.file;
        paper_.title = std::string(quantity_.title) + ": error over time per tick, " + cut(scene_.scene, 60);
        paper_.subtitle = cut(scene_.path, 90) + ". Lower is nearer the truth, left is faster.";
        if (noticeable_ != nullptr)
            paper_.notes.push_back("Just noticeable: " + noticeable_->source);
        figure.script = openPaper(figure.name, paper_, result_.provenance);
        figure.script += x_.script('x') + y_.script('y') + axisWords() + noticeableLine() + band();
        figure.data = data();
        figure.script += labels() + key() + plots(figure.name);
        return figure;
    }

  private:
    /// The largest ablation numbers its front only, the others every configuration; within an ablation by
    /// time.
    void number() {
        std::vector<size_t> sizes(ablations_.size());
        for (const Point& p : points_)
            ++sizes[p.ablation];
        const size_t most = sizes.empty() ? 0 : *std::max_element(sizes.begin(), sizes.end());
        std::stable_sort(points_.begin(), points_.end(), [](const Point& a, const Point& b) {
            return a.ablation != b.ablation ? a.ablation < b.ablation
                                            : a.configuration->step.value < b.configuration->step.value;
        });
        int next = 0;
        for (Point& p : points_)
            if (next < kMaxNumbers &&
                (sizes[p.ablation] < std::max(most, kLargeAblation) || p.front || p.configuration->isDefault))
                p.number = ++next;
    }

    /// Makes the page as high as its legend.
    void makeRoom() {
        double key = kKeyEnd + kKeyAblation * static_cast<double>(ablations_.size());
        for (const Point& p : points_)
            key += p.number > 0 ? kKeyRung : 0.0;
        const double below = paper_.height - paper_.area.top;
        paper_.height = std::max(paper_.height, key + below + 40.0);
        paper_.area.top = paper_.height - below;
    }

    void chooseAxes() {
        std::vector<double> times, errors;
        bool exact = false;
        for (const Point& p : points_) {
            for (const double ns :
                 {p.configuration->step.low, p.configuration->step.value, p.configuration->step.high})
                times.push_back(1e-3 * ns);
            errors.push_back(p.error);
            exact = exact || !(p.error >= quantity_.floor);
        }
        if (noticeable_ != nullptr)
            errors.push_back(quantity_.inUnit * noticeable_->value);
        x_ = LogAxis::around(times);
        y_ = LogAxis::around(errors, quantity_.floor);
        y_.band = exact;
        y_.bandTic = "exact";
    }

    [[nodiscard]] std::string axisWords() const {
        return "set xlabel 'time per tick in contact, µs (median; bar: 95 % interval)'\n"
               "set ylabel 'error of the " +
               std::string(quantity_.name == "force"      ? "force"
                           : quantity_.name == "position" ? "proxy''s place"
                                                          : "force''s direction") +
               ", " + std::string(quantity_.unit) + " (99 % of ticks are nearer)' offset 0.5,0\n";
    }

    [[nodiscard]] std::string noticeableLine() const {
        if (noticeable_ == nullptr)
            return "";
        const double value = quantity_.inUnit * noticeable_->value;
        return "set arrow from graph 0, first " + std::to_string(value) + " to graph 1, first " +
               std::to_string(value) + " nohead dt (8,5) lw 1.6 lc rgb '#a00000' back\n" + "set label " +
               inQuotes("just noticeable: " + brief(value) + " " + std::string(quantity_.unit)) +
               " at graph 0.99, first " + std::to_string(value) +
               " right offset 0,0.6 tc rgb '#a00000' font ',12' front\n";
    }

    /// Below a break in the axis: errors too small for the logarithmic axis.
    [[nodiscard]] std::string band() const {
        if (!y_.band)
            return "";
        const Area& a = paper_.area;
        const double top = a.bottom + y_.fraction(y_.low) * (a.top - a.bottom);
        std::string script = "set object rectangle from graph 0,0 to graph 1, first " + brief(y_.low) +
                             " fc rgb '#f2f2f2' fs solid noborder behind\n";
        // Two short strokes across the axis.
        for (const double y : {top - 3.0, top + 3.0})
            script += "set arrow from screen " + at(a.left - 6.0, y - 3.0) + " to screen " +
                      at(a.left + 6.0, y + 3.0) + " nohead lw 1.4 lc rgb '#555555' front\n";
        return script + labelAt(paper_, a.right - 6.0, a.bottom + 10.0,
                                "below " + brief(y_.low) + " " + std::string(quantity_.unit),
                                "right tc rgb '#777777'", 10.5);
    }

    [[nodiscard]] std::string at(double x, double y) const {
        std::array<char, 64> text{};
        std::snprintf(text.data(), text.size(), "%.6f,%.6f", x / paper_.width, y / paper_.height);
        return text.data();
    }
    [[nodiscard]] Obstacle pixel(const Point& p) const {
        const Area& a = paper_.area;
        return {x_.fraction(1e-3 * p.configuration->step.value) * (a.right - a.left),
                y_.fraction(y_.place(p.error)) * (a.top - a.bottom)};
    }

    /// Numbers beside the points, with a leader line to distant ones.
    [[nodiscard]] std::string labels() const {
        constexpr double kHalfWidth = 8.0, kHalfHeight = 6.0, kMarkSize = 4.5;
        const Area& a = paper_.area;
        std::vector<Obstacle> anchors, marks;
        std::vector<const Point*> owners;
        for (const Point& p : points_) {
            marks.push_back(pixel(p));
            if (p.configuration->isDefault) // ring of the default
                marks.back().halfWidth = marks.back().halfHeight = 5.5;
            const double low = x_.fraction(1e-3 * p.configuration->step.low),
                         high = x_.fraction(1e-3 * p.configuration->step.high);
            if (high > low) // interval
                marks.push_back({0.5 * (low + high) * (a.right - a.left), marks.back().y,
                                 0.5 * (high - low) * (a.right - a.left) - kMarkSize, 0.0});
            if (p.number > 0) {
                anchors.push_back(pixel(p));
                owners.push_back(&p);
            }
        }
        if (noticeable_ != nullptr)
            marks.push_back({0.5 * (a.right - a.left),
                             y_.fraction(quantity_.inUnit * noticeable_->value) * (a.top - a.bottom),
                             0.5 * (a.right - a.left), 1.0});
        const std::vector<PlacedLabel> places =
            placeLabels(anchors, marks, kHalfWidth, kHalfHeight, a.right - a.left, a.top - a.bottom);
        std::string script;
        for (size_t i = 0; i < places.size(); ++i) {
            const PlacedLabel& l = places[i];
            const std::string colour(markOf(owners[i]->ablation).colour);
            if (l.leader)
                script += "set arrow from screen " + at(a.left + anchors[i].x, a.bottom + anchors[i].y) +
                          " to screen " + at(a.left + l.x, a.bottom + l.y) +
                          " nohead lw 0.7 lc rgb '#999999' back\n";
            script += labelAt(paper_, a.left + l.x, a.bottom + l.y, std::to_string(owners[i]->number),
                              "center tc rgb '" + colour + "'", 12.0);
        }
        return script;
    }

    /// Ablations with their marks, and under each its numbered configurations.
    [[nodiscard]] std::string key() const {
        const double left = paper_.area.right + 26.0;
        double y = paper_.area.top;
        std::string script;
        const auto down = [&](double by) { y -= by; };
        for (size_t ablation = 0; ablation < ablations_.size(); ++ablation) {
            size_t configurations = 0, numbered = 0;
            Truth truth = Truth::Oracle;
            for (const Point& p : points_)
                if (p.ablation == ablation) {
                    ++configurations;
                    numbered += p.number > 0 ? 1 : 0;
                    truth = p.configuration->truth;
                }
            script += markAt(paper_, left + 5.0, y, markOf(ablation));
            script +=
                labelAt(paper_, left + 18.0, y,
                        cut(ablations_[ablation], 30) + ", against " +
                            std::string(kAgainst[static_cast<size_t>(truth)]) +
                            (numbered < configurations ? " (" + std::to_string(configurations) + "):" : ""),
                        "tc rgb '" + std::string(markOf(ablation).colour) + "'", 12.5);
            down(kKeyTitle);
            for (const Point& p : points_)
                if (p.ablation == ablation && p.number > 0) {
                    script += labelAt(paper_, left + 34.0, y, std::to_string(p.number), "right", 11.5);
                    script += labelAt(paper_, left + 42.0, y,
                                      cut(p.configuration->configuration, 50) +
                                          (p.configuration->isDefault ? " (default)" : ""),
                                      "", 11.5);
                    down(kKeyRung);
                }
            down(kKeyAblation - kKeyTitle);
        }
        script += "set arrow from screen " + at(left - 3.0, y) + " to screen " + at(left + 14.0, y) +
                  " nohead lw 2 lc rgb '#666666' front\n" +
                  labelAt(paper_, left + 20.0, y,
                          "Pareto front: no configuration of the ablation beats these", "", 11.5);
        down(0.5 * kKeyEnd);
        script += "set label '' at screen " + at(left + 5.0, y) +
                  " point pt 6 ps 1.9 lw 1.6 lc rgb '#000000' front\n" +
                  labelAt(paper_, left + 20.0, y, "what the program does by itself", "", 11.5);
        return script;
    }

    /// One block per ablation: time, its interval, error, drawn error, flags for front and default.
    [[nodiscard]] std::string data() const {
        std::string text;
        for (size_t ablation = 0; ablation < ablations_.size(); ++ablation) {
            text += "# " + ablations_[ablation] + ": time, low, high (us), error as drawn (" +
                    std::string(quantity_.unit) + "), error, front, default\n";
            for (const Point& p : points_)
                if (p.ablation == ablation) {
                    std::array<char, 256> line{};
                    std::snprintf(line.data(), line.size(), "%.9g %.9g %.9g %.9g %.9g %d %d # ",
                                  1e-3 * p.configuration->step.value, 1e-3 * p.configuration->step.low,
                                  1e-3 * p.configuration->step.high, y_.place(p.error), p.error,
                                  p.front ? 1 : 0, p.configuration->isDefault ? 1 : 0);
                    text += line.data() + slug(p.configuration->configuration) + "\n";
                }
            text += "\n\n";
        }
        return text;
    }

    [[nodiscard]] std::string plots(const std::string& name) const {
        std::string script = "set datafile missing NaN\nplot "; // lines bridge missing values
        const std::string file = "'" + name + ".dat'";
        for (size_t i = 0; i < ablations_.size(); ++i) {
            const std::string colour(markOf(i).colour), index = " index " + std::to_string(i);
            script += (i > 0 ? ", \\\n  " : "") + file + index +
                      " using ($6 == 1 ? $1 : NaN):4 with lines lw 1.6 lc rgb '" + colour + "', \\\n  " +
                      file + index + " using 1:4:2:3 with xerrorbars pt 0 lw 1 lc rgb '" + colour +
                      "', \\\n  " + file + index + " using 1:4 with points pt " +
                      std::to_string(markOf(i).point) + " ps 0.75 lc rgb '" + colour + "', \\\n  " + file +
                      index + " using ($7 == 1 ? $1 : NaN):4 with points pt 6 ps 1.9 lw 1.6 lc rgb '#000000'";
        }
        return script + "\n";
    }

    /// Pixels of the legend: a configuration's line, an ablation's title, the title with its gap, the two
    /// lines at the end.
    static constexpr double kKeyRung = 15.5, kKeyTitle = 18.0, kKeyAblation = 25.0, kKeyEnd = 38.0;
    static constexpr int kMaxNumbers = 48;      ///< upper bound for a readable legend
    static constexpr size_t kLargeAblation = 8; ///< number of configurations above which only the front is
                                                ///< numbered
    const SceneRungs& scene_;
    const Quantity& quantity_;
    const StudyResult& result_;
    const JustNoticeable* noticeable_ = nullptr;
    std::vector<std::string> ablations_;
    std::vector<Point> points_;
    Paper paper_;
    LogAxis x_, y_;
};

} // namespace

std::vector<Figure> errorOverTime(const StudyResult& result) {
    std::vector<Figure> figures;
    for (const SceneRungs& scene : byScene(result, false))
        for (const Quantity& quantity : kQuantities) {
            ErrorPlot plot(scene, quantity, result);
            if (!plot.empty())
                figures.push_back(plot.figure());
        }
    return figures;
}

} // namespace touchstone::study

#include "study/report/plots/figures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

namespace touchstone::study {

namespace {

constexpr std::array<std::string_view, kStageCount> kStageColours{"#888888", "#0072b2", "#56b4e9", "#009e73",
                                                                  "#e69f00", "#d55e00", "#b0498c", "#444444"};
constexpr double kBarHeight = 19.0; // pixels, with the gap
constexpr size_t kMaxBars = 60;

class StagePlot {
  public:
    StagePlot(const SceneRungs& scene, const StudyResult& result) : scene_(scene), result_(result) {
        // Configurations of different ablations with equal effective settings are one measurement.
        std::set<std::string> shown;
        size_t large = 0;
        for (const ConfigurationResult* configuration : scene.configurations)
            large += configuration->stepMean.value > 0.0 ? 1 : 0;
        for (const ConfigurationResult* configuration : scene.configurations)
            if (configuration->stepMean.value > 0.0 && configurations_.size() < kMaxBars &&
                (large <= kMaxBars / 2 || configuration->ablation != largest() || configuration->pareto ||
                 configuration->isDefault) &&
                shown.insert(configuration->ablation + "\n" + configuration->configuration).second)
                configurations_.push_back(configuration);
        paper_.width = 1180.0;
        paper_.area.left = 400.0;
        paper_.area.right = 1140.0;
        paper_.area.bottom = 105.0;
        paper_.height = 105.0 + rows() * kBarHeight + 110.0;
        paper_.area.top = paper_.height - 110.0;
    }
    [[nodiscard]] bool empty() const { return configurations_.empty(); }

    [[nodiscard]] Figure figure() {
        Figure figure;
        figure.name = "stages_" + scene_.file;
        paper_.title = "What a tick spends its time on, " + cut(scene_.scene, 60);
        paper_.subtitle =
            cut(scene_.path, 80) + ". Mean over the ticks in contact; the clock's own cost is taken off.";
        figure.script = openPaper(figure.name, paper_, result_.provenance);
        double most = 0.0;
        for (const ConfigurationResult* configuration : configurations_)
            most = std::max({most, configuration->stepMean.value, sum(*configuration)});
        std::array<char, 200> line{};
        std::snprintf(line.data(), line.size(),
                      "set xrange [0:%.6g]\nset yrange [%.6g:%.6g]\nunset ytics\nset border 1\n", 1.04 * most,
                      rows() - 0.5, -0.5);
        figure.script += line.data();
        figure.script += "set grid noytics\nset xlabel 'time per tick, ns'\n";
        figure.script += names() + key();
        figure.data = data();
        figure.script += "plot ";
        for (size_t s = 0; s < kStageCount; ++s)
            figure.script += "'" + figure.name + ".dat' using " + std::to_string(5 + s) +
                             ":1:" + std::to_string(5 + s) + ":" + std::to_string(6 + s) +
                             ":($1-0.38):($1+0.38) with boxxyerror fs solid 1 noborder lc rgb '" +
                             std::string(kStageColours[s]) + "', \\\n  ";
        figure.script +=
            "'" + figure.name +
            ".dat' using 2:($1-0.46):(0):(0.92) with vectors nohead lw 2.6 lc rgb '#000000', \\\n  "
            "'" +
            figure.name + ".dat' using 3:1:($4-$3):(0) with vectors nohead lw 1.2 lc rgb '#000000'\n";
        return figure;
    }

  private:
    static double sum(const ConfigurationResult& configuration) {
        double total = 0.0;
        for (const Estimate& stage : configuration.stages)
            total += std::max(0.0, stage.value);
        return total;
    }
    /// The ablation with the most configurations of this scene.
    [[nodiscard]] std::string largest() const {
        std::string name;
        std::ptrdiff_t most = 0;
        for (const ConfigurationResult* candidate : scene_.configurations) {
            const auto size = std::count_if(
                scene_.configurations.begin(), scene_.configurations.end(),
                [&](const ConfigurationResult* r) { return r->ablation == candidate->ablation; });
            if (size > most) {
                most = size;
                name = candidate->ablation;
            }
        }
        return name;
    }
    [[nodiscard]] double rows() const {
        double count = 0.0;
        const std::string* last = nullptr;
        for (const ConfigurationResult* configuration : configurations_) {
            count += last != nullptr && *last != configuration->ablation ? 1.6 : 1.0;
            last = &configuration->ablation;
        }
        return count;
    }
    /// Calls `each` with every configuration and its row; ablations are separated.
    void eachRow(const auto& each) const {
        double row = 0.0;
        const std::string* last = nullptr;
        for (const ConfigurationResult* configuration : configurations_) {
            const bool begins = last == nullptr || *last != configuration->ablation;
            row += last != nullptr && begins ? 0.6 : 0.0;
            each(*configuration, row, begins);
            row += 1.0;
            last = &configuration->ablation;
        }
    }
    [[nodiscard]] std::string names() const {
        std::string script;
        eachRow([&](const ConfigurationResult& configuration, double row, bool begins) {
            const double y = paper_.area.top - (row + 0.5) / rows() * (paper_.area.top - paper_.area.bottom);
            if (begins)
                script += labelAt(paper_, 20.0, y, cut(configuration.ablation, 16), "tc rgb '#0072b2'", 12.0);
            script +=
                labelAt(paper_, paper_.area.left - 8.0, y,
                        cut(configuration.configuration, 46) + (configuration.isDefault ? " (default)" : ""),
                        "right", 11.5);
        });
        return script;
    }
    [[nodiscard]] std::string key() const {
        std::string script;
        double x = paper_.area.left;
        const double y = paper_.height - 82.0;
        const auto fraction = [](double value) { return std::to_string(value); };
        for (size_t s = 0; s < kStageCount; ++s) {
            script += "set object rectangle from screen " + fraction(x / paper_.width) + "," +
                      fraction((y - 5.0) / paper_.height) + " to screen " +
                      fraction((x + 12.0) / paper_.width) + "," + fraction((y + 5.0) / paper_.height) +
                      " fc rgb '" + std::string(kStageColours[s]) + "' fs solid noborder\n";
            script += labelAt(paper_, x + 17.0, y, kStageNames[s], "", 11.5);
            x += 28.0 + textWidth(kStageNames[s], 11.5);
        }
        return script + labelAt(paper_, x + 6.0, y, "┃ whole tick (line: 95 %)", "", 11.5);
    }
    /// Row, mean of the plain step and its interval, then start and end of each stage.
    [[nodiscard]] std::string data() const {
        std::string text =
            "# row, mean of the whole step, its 95 % interval, ends of the stages one on another (ns)\n";
        eachRow([&](const ConfigurationResult& configuration, double row, bool) {
            std::array<char, 64> cell{};
            const auto put = [&](double value) {
                std::snprintf(cell.data(), cell.size(), "%.9g ", value);
                text += cell.data();
            };
            put(row);
            put(configuration.stepMean.value);
            put(configuration.stepMean.low);
            put(configuration.stepMean.high);
            double end = 0.0;
            put(end);
            for (const Estimate& stage : configuration.stages)
                put(end += std::max(0.0, stage.value));
            text += "# " + slug(configuration.ablation + " " + configuration.configuration) + "\n";
        });
        return text;
    }

    const SceneRungs& scene_;
    const StudyResult& result_;
    std::vector<const ConfigurationResult*> configurations_;
    Paper paper_;
};

} // namespace

std::vector<Figure> costByStage(const StudyResult& result) {
    std::vector<Figure> figures;
    for (const SceneRungs& scene : byScene(result, false)) {
        StagePlot plot(scene, result);
        if (!plot.empty())
            figures.push_back(plot.figure());
    }
    return figures;
}

} // namespace touchstone::study

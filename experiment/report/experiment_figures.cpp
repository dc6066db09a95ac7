#include "experiment/report/experiment_figures.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <set>

namespace touchstone::experiment {

namespace {

using study::Figure;
using study::inQuotes;
using study::Paper;

[[gnu::format(printf, 1, 2)]] std::string printed(const char* format, ...) {
    std::array<char, 512> text{};
    std::va_list values;
    va_start(values, format);
    std::vsnprintf(text.data(), text.size(), format, values);
    va_end(values);
    return text.data();
}

std::string levelWords(const Condition& condition) {
    return condition.varied == Varied::Segments
               ? "number of segments"
               : condition.setting + ", % of the way to " + study::brief(condition.hard);
}

/// True where no two of these conditions differ at 0.05.
bool alike(const std::vector<size_t>& group, const Variance& variance) {
    constexpr double kSignificant = 0.05;
    return std::none_of(variance.tukey.begin(), variance.tukey.end(), [&](const Comparison& pair) {
        const auto in = [&](size_t at) { return std::find(group.begin(), group.end(), at) != group.end(); };
        return in(pair.first) && in(pair.second) && pair.p < kSignificant;
    });
}

} // namespace

std::vector<std::string> groupLetters(const Variance& variance) {
    const size_t count = variance.means.size();
    std::vector<size_t> sorted(count);
    for (size_t i = 0; i < count; ++i)
        sorted[i] = i;
    std::sort(sorted.begin(), sorted.end(),
              [&](size_t a, size_t b) { return variance.means[a].mean > variance.means[b].mean; });
    std::vector<std::string> letters(count);
    char letter = 'a';
    size_t ended = 0; // the last group reached so far
    for (size_t from = 0; from < count; ++from) {
        std::vector<size_t> group{sorted[from]};
        size_t to = from + 1;
        while (to < count) {
            group.push_back(sorted[to]);
            if (!alike(group, variance)) {
                group.pop_back();
                break;
            }
            ++to;
        }
        if (from > 0 && to <= ended)
            continue; // inside of the group before
        ended = to;
        for (const size_t at : group)
            letters[at] += letter;
        ++letter;
    }
    return letters;
}

Figure staircaseFigure(const PersonSession& session, const study::Provenance& where) {
    Figure figure;
    std::vector<size_t> shown;
    for (const size_t at : session.order())
        if (session.trialsOf(at) > 0 && session.plan().conditions[at].varied != Varied::Nothing)
            shown.push_back(at);
    if (shown.empty())
        return figure;
    std::sort(shown.begin(), shown.end());
    figure.name = printed("staircase_person_%02zu", session.start().person + 1);
    const size_t rows = (shown.size() + 1) / 2;
    Paper paper;
    paper.width = 1180.0;
    paper.height = 140.0 + 290.0 * static_cast<double>(rows);
    paper.area = {80.0, 560.0, 80.0, paper.height - 90.0};
    paper.title =
        printed("Staircases of person %zu: %s", session.start().person + 1, session.start().device.c_str());
    paper.subtitle = session.plan().name + ". The threshold is the mean level of the last reversals.";
    figure.script = study::openPaper(figure.name, paper, where) + "set multiplot\n";
    std::string blocks;
    for (size_t i = 0; i < shown.size(); ++i) {
        const Condition& condition = session.plan().conditions[shown[i]];
        size_t number = 0;
        double most = 0.0;
        for (const TrialRecord& trial : session.trials())
            if (trial.condition == shown[i]) {
                blocks += printed("%zu %.9g %d %d\n", ++number, trial.level, trial.right ? 1 : 0,
                                  trial.reversal ? 1 : 0);
                most = std::max(most, trial.level);
            }
        blocks += "\n\n";
        const double top = paper.height - 110.0 - 290.0 * static_cast<double>(i / 2),
                     left = i % 2 == 0 ? 80.0 : 660.0;
        const auto threshold = session.threshold(shown[i]);
        figure.script += i > 0 ? "unset label\nunset arrow\n" : "";
        figure.script += printed("set lmargin at screen %.5f\nset rmargin at screen %.5f\nset tmargin at "
                                 "screen %.5f\nset bmargin at screen %.5f\n",
                                 left / paper.width, (left + 480.0) / paper.width, top / paper.height,
                                 (top - 200.0) / paper.height);
        figure.script += printed("set xrange [0:%zu]\nset yrange [0:%.6g]\n", number + 1, 1.15 * most);
        figure.script +=
            "set xlabel 'trial' offset 0,0.4\nset ylabel " + inQuotes(levelWords(condition)) + "\n";
        figure.script +=
            "set title " +
            inQuotes(condition.name + ", " + condition.title +
                     (threshold ? ": threshold " + study::brief(*threshold) : ": not finished")) +
            " offset 0,-0.5\n";
        if (threshold)
            figure.script += printed("set arrow from 0,%.9g to %zu,%.9g nohead dt (8,5) lc rgb '#555555'\n",
                                     *threshold, number + 1, *threshold);
        figure.script += i == 0 ? "set key at screen 0.95,0.045 right horizontal samplen 1\n" : "unset key\n";
        const std::string data = inQuotes(figure.name + ".dat") + printed(" index %zu", i);
        figure.script +=
            "plot " + data + " using 1:2 with lines lc rgb '#bbbbbb' notitle, " + data +
            " using 1:($3==1?$2:1/0) with points pt 7 ps 0.55 lc rgb '#0072b2' title 'right', " + data +
            " using 1:($3==0?$2:1/0) with points pt 2 ps 0.8 lw 1.6 lc rgb '#d55e00' title 'wrong', " + data +
            " using 1:($4==1?$2:1/0) with points pt 6 ps 1.5 lc rgb '#222222' title 'reversal'\n";
    }
    figure.script += "unset multiplot\n";
    figure.data = "# trial, level, right, reversal; a block for each condition\n" + blocks;
    return figure;
}

Figure thresholdFigure(const ExperimentResult& result, const study::Provenance& where) {
    Figure figure;
    std::vector<const ConditionResult*> shown;
    for (const ConditionResult& row : result.conditions)
        if (!row.thresholds.empty())
            shown.push_back(&row);
    if (shown.empty())
        return figure;
    figure.name = "thresholds";
    Paper paper;
    paper.width = 980.0;
    paper.height = 640.0;
    paper.area = {90.0, 720.0, 110.0, 555.0};
    paper.title = "Levels at which 70.7 % of the answers are right";
    paper.subtitle = result.plan.name + ". Bars: 95 % intervals of the means.";
    const auto people = std::max_element(shown.begin(), shown.end(), [](auto* a, auto* b) {
        return a->thresholds.size() < b->thresholds.size();
    });
    paper.notes = {printed("%zu people. Conditions that share a letter are not told apart by Tukey's test at "
                           "0.05 (repeated measures).",
                           (*people)->thresholds.size())};
    figure.script = study::openPaper(figure.name, paper, where);
    const auto letters = result.variance ? groupLetters(*result.variance) : std::vector<std::string>{};
    std::string means, each, papers, observer, tics;
    double most = 0.0;
    std::vector<double> all;
    for (size_t i = 0; i < shown.size(); ++i) {
        const ConditionResult& row = *shown[i];
        const Condition& condition = result.plan.conditions[row.condition];
        const auto x = static_cast<double>(i + 1);
        means += printed("%g %.9g %.9g %.9g\n", x, row.mean.mean,
                         std::max(row.mean.mean - row.mean.half, 1e-3), row.mean.mean + row.mean.half);
        for (const double threshold : row.thresholds)
            each += printed("%g %.9g\n", x - 0.12, threshold);
        all.insert(all.end(), row.thresholds.begin(), row.thresholds.end());
        all.push_back(row.mean.mean + row.mean.half);
        if (const PaperResult* paper004 = paperResult(result.plan, condition)) {
            const double level = paper004->segments > 0.0 ? paper004->segments : 51.68 / paper004->degrees;
            papers += printed("%g %.9g %.9g %.9g\n", x + 0.16, level, level - paper004->half,
                              level + paper004->half);
            all.insert(all.end(), {level, level - paper004->half, level + paper004->half});
        }
        if (row.observer)
            observer += printed("%g %.9g\n", x, *row.observer);
        tics += (tics.empty() ? "" : ", ") + inQuotes(condition.name) + printed(" %g", x);
        most = std::max(most, row.mean.mean);
    }
    const study::LogAxis axis = study::LogAxis::around(all);
    figure.script +=
        axis.script('y') + printed("set xrange [0.5:%g]\n", static_cast<double>(shown.size()) + 0.5) +
        "set xtics (" + tics + ")\n" + "set ylabel " +
        inQuotes(levelWords(result.plan.conditions[shown.front()->condition])) + "\nset xlabel 'condition'\n";
    for (size_t i = 0; i < letters.size(); ++i)
        for (size_t place = 0; place < shown.size(); ++place)
            if (shown[place]->condition == result.compared[i])
                figure.script += "set label " + inQuotes(letters[i]) +
                                 printed(" at first %zu, graph 0.97 center font ',14' front\n", place + 1);
    figure.script += "set key at screen 0.76,0.8 left reverse Left samplen 1.5 spacing 1.5\nplot ";
    std::string plots, data;
    size_t index = 0;
    const auto add = [&](const std::string& block, const std::string& with) {
        if (block.empty())
            return;
        plots +=
            (plots.empty() ? "" : ", ") + ("'thresholds.dat' index " + std::to_string(index++)) + " " + with;
        data += block + "\n\n";
    };
    add(each, "using 1:2 with points pt 6 ps 0.5 lc rgb '#999999' title 'one person'");
    add(means, "using 1:2:3:4 with yerrorbars pt 7 ps 0.9 lw 1.6 lc rgb '#0072b2' title 'mean, 95 %'");
    add(observer, "using 1:2 with points pt 12 ps 1.3 lw 1.6 lc rgb '#009e73' title 'observer, exact'");
    add(papers,
        "using 1:2:3:4 with yerrorbars pt 5 ps 0.8 lw 1.6 lc rgb '#d55e00' title '[004], twelve people'");
    figure.script += plots + "\n";
    figure.data = "# condition, level (low, high); blocks: people, means, observer, paper\n" + data;
    return figure;
}

Figure powerFigure(const ExperimentResult& result, const study::Provenance& where) {
    Figure figure;
    if (result.power.empty())
        return figure;
    figure.name = "power";
    Paper paper;
    paper.width = 980.0;
    paper.height = 560.0;
    paper.area = {90.0, 700.0, 115.0, 480.0};
    paper.title = "How many people tell the conditions apart";
    paper.subtitle = result.plan.name + ". Simulated experiments in which p < 0.05.";
    std::set<size_t> reversals;
    for (const PowerRow& row : result.power)
        reversals.insert(row.reversals);
    const size_t usual = result.plan.conditions[result.compared.front()].rule.reversals;
    const size_t drawn = reversals.contains(usual) ? usual : *reversals.begin();
    paper.notes = {printed("%zu reversals. The people differ as docs/experiment.md assumes.", drawn)};
    figure.script = study::openPaper(figure.name, paper, where) +
                    "set xlabel 'people'\nset ylabel 'share of experiments'\nset yrange [0:1.05]\nset key at "
                    "screen 0.74,0.8 left reverse Left samplen 2 spacing 1.4\nplot ";
    figure.data = "# people, ANOVA, then each pair by Tukey\n";
    for (const PowerRow& row : result.power)
        if (row.reversals == drawn) {
            figure.data += printed("%zu %.6g", row.people, row.anova);
            for (const double told : row.told)
                figure.data += printed(" %.6g", told);
            figure.data += "\n";
        }
    size_t column = 3;
    figure.script +=
        "'power.dat' using 1:2 with linespoints pt 7 ps 0.8 lw 2 lc rgb '#222222' title 'ANOVA, corrected'";
    for (size_t i = 0; i < result.compared.size(); ++i)
        for (size_t j = i + 1; j < result.compared.size(); ++j) {
            const study::Mark mark = study::markOf(column - 3);
            const std::string pair = result.plan.conditions[result.compared[i]].name + " from " +
                                     result.plan.conditions[result.compared[j]].name;
            figure.script +=
                printed(", 'power.dat' using 1:%zu with linespoints pt %d ps 0.8 lc rgb '%s' title ", column,
                        mark.point, std::string(mark.colour).c_str()) +
                inQuotes(pair);
            ++column;
        }
    figure.script += "\n";
    return figure;
}

} // namespace touchstone::experiment

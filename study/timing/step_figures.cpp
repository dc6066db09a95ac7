#include "study/timing/step_figures.h"

#include "study/timing/interval.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace touchstone::study {

namespace {

constexpr size_t kFewestWhole = 20, kFewestSplit = 4; // minimum contact ticks of a round
constexpr double kKept = 0.99;

/// The time that the fraction kKept of the ticks of all rounds does not exceed.
template <class Pick>
double slowestKept(std::span<const RoundTimes> rounds, Pick pick) {
    std::vector<double> all;
    for (const RoundTimes& round : rounds)
        all.insert(all.end(), pick(round).begin(), pick(round).end());
    if (all.empty())
        return 0.0;
    const auto rank = static_cast<std::ptrdiff_t>(kKept * static_cast<double>(all.size() - 1));
    std::nth_element(all.begin(), all.begin() + rank, all.end());
    return all[static_cast<size_t>(rank)];
}

std::optional<double> meanUpTo(const std::vector<double>& ticks, double slowest, size_t fewest) {
    double sum = 0.0;
    size_t count = 0;
    for (const double ns : ticks)
        if (ns <= slowest) {
            sum += ns;
            ++count;
        }
    if (count < fewest)
        return std::nullopt;
    return sum / static_cast<double>(count);
}

double medianIn(std::vector<double> ticks) {
    std::sort(ticks.begin(), ticks.end());
    return 0.5 * (ticks[(ticks.size() - 1) / 2] + ticks[ticks.size() / 2]);
}

/// Time of each stage in one round; nullopt where one of them has too few ticks.
std::optional<std::array<double, kStageCount>>
stagesOf(const RoundTimes& round, const std::array<double, kStageCount>& slowest, double clock) {
    std::array<double, kStageCount> stages{};
    double before = clock;
    for (size_t s = 0; s < kStageCount; ++s) {
        const std::optional<double> mean = meanUpTo(round.upTo[s], slowest[s], kFewestSplit);
        if (!mean)
            return std::nullopt;
        stages[s] = *mean - before;
        before = *mean;
    }
    return stages;
}

} // namespace

StepFigures figuresOf(std::span<const RoundTimes> rounds, double clock) {
    const double slowestWhole = slowestKept(
        rounds, [](const RoundTimes& round) -> const auto& { return round.whole; });
    std::array<double, kStageCount> slowest{};
    for (size_t s = 0; s < kStageCount; ++s)
        slowest[s] = slowestKept(
            rounds, [s](const RoundTimes& round) -> const auto& { return round.upTo[s]; });
    std::vector<double> medians, means;
    std::array<std::vector<double>, kStageCount> stages;
    for (const RoundTimes& round : rounds) {
        if (const auto mean = meanUpTo(round.whole, slowestWhole, kFewestWhole)) {
            means.push_back(*mean - clock);
            medians.push_back(medianIn(round.whole) - clock);
        }
        if (const auto ofRound = stagesOf(round, slowest, clock))
            for (size_t s = 0; s < kStageCount; ++s)
                stages[s].push_back((*ofRound)[s]);
    }
    StepFigures figures;
    figures.median = acrossRuns(medianOf(medians));
    figures.mean = acrossRuns(meanOf(means));
    for (size_t s = 0; s < kStageCount; ++s)
        figures.stages[s] = meanOf(stages[s]);
    return figures;
}

} // namespace touchstone::study

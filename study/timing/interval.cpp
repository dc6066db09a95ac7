#include "study/timing/interval.h"

#include <algorithm>
#include <numeric>
#include <random>

namespace touchstone::study {

namespace {

constexpr int kDraws = 2000;

double medianIn(std::vector<double>& values) {
    const size_t middle = values.size() / 2;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(middle);
    std::nth_element(values.begin(), at, values.end());
    const double upper = *at;
    if (values.size() % 2 == 1)
        return upper;
    return 0.5 * (upper + *std::max_element(values.begin(), at));
}

double meanIn(std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

template <class Statistic>
Estimate bootstrap(std::span<const double> rounds, Statistic statistic) {
    if (rounds.empty())
        return {};
    std::mt19937 random(1);
    // Not std::uniform_int_distribution, whose sequence depends on the library.
    const auto draw = [&] { return rounds[random() % rounds.size()]; };
    std::vector<double> sample(rounds.begin(), rounds.end());
    Estimate estimate;
    estimate.value = statistic(sample);
    std::vector<double> drawn;
    for (int i = 0; i < kDraws; ++i) {
        std::generate(sample.begin(), sample.end(), draw);
        drawn.push_back(statistic(sample));
    }
    std::sort(drawn.begin(), drawn.end());
    estimate.low = drawn[static_cast<size_t>(0.025 * kDraws)];
    estimate.high = drawn[static_cast<size_t>(0.975 * kDraws) - 1];
    return estimate;
}

} // namespace

Estimate medianOf(std::span<const double> rounds) {
    return bootstrap(rounds, medianIn);
}

Estimate meanOf(std::span<const double> rounds) {
    return bootstrap(rounds, meanIn);
}

} // namespace touchstone::study

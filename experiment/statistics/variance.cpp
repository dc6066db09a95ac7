#include "experiment/statistics/variance.h"

#include "engine/core/error.h"
#include "experiment/statistics/distributions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace touchstone::experiment {

namespace {

void check(const Thresholds& values) {
    const auto refuse = [](const char* problem, const char* remedy) {
        throw Error("analysis of variance", "", problem, remedy);
    };
    if (values.size() < 2)
        refuse("it needs two people at least", "run more people");
    if (values.front().size() < 2)
        refuse("it needs two conditions at least", "complete more conditions");
    for (const auto& row : values) {
        if (row.size() != values.front().size())
            refuse("people have different conditions", "leave out those that are not complete");
        if (!std::all_of(row.begin(), row.end(), [](double value) { return std::isfinite(value); }))
            refuse("a threshold is not a number", "leave out that person");
    }
}

FTest fTest(double between, double degreesBetween, double within, double degreesWithin) {
    FTest test{.between = degreesBetween, .within = degreesWithin, .error = within / degreesWithin};
    const double mean = between / degreesBetween;
    test.f = test.error > 0.0 ? mean / test.error
             : mean > 0.0     ? std::numeric_limits<double>::infinity()
                              : 0.0;
    test.p = fTail(test.f, degreesBetween, degreesWithin);
    return test;
}

std::vector<Comparison> tukey(const std::vector<Mean>& means, const FTest& test, size_t people,
                              bool probabilities) {
    std::vector<Comparison> pairs;
    const double scale = std::sqrt(test.error / static_cast<double>(people));
    for (size_t i = 0; i < means.size(); ++i)
        for (size_t j = i + 1; j < means.size(); ++j) {
            Comparison pair{.first = i, .second = j, .difference = means[j].mean - means[i].mean};
            pair.q = scale > 0.0 ? std::abs(pair.difference) / scale : pair.difference != 0.0 ? 1e3 : 0.0;
            if (probabilities)
                pair.p = studentizedRangeTail(pair.q, static_cast<int>(means.size()), test.within);
            pairs.push_back(pair);
        }
    return pairs;
}

/// (trace of the centred covariance)^2 / ((k - 1) sum of the squares of its entries).
double sphericity(const Thresholds& values, const std::vector<Mean>& means) {
    const size_t n = values.size(), k = means.size();
    std::vector<std::vector<double>> s(k, std::vector<double>(k, 0.0));
    for (const auto& row : values)
        for (size_t i = 0; i < k; ++i)
            for (size_t j = 0; j < k; ++j)
                s[i][j] += (row[i] - means[i].mean) * (row[j] - means[j].mean) / static_cast<double>(n - 1);
    std::vector<double> rows(k, 0.0);
    double all = 0.0;
    for (size_t i = 0; i < k; ++i)
        for (size_t j = 0; j < k; ++j) {
            rows[i] += s[i][j] / static_cast<double>(k);
            all += s[i][j] / static_cast<double>(k * k);
        }
    double trace = 0.0, squares = 0.0;
    for (size_t i = 0; i < k; ++i)
        for (size_t j = 0; j < k; ++j) {
            const double centred = s[i][j] - rows[i] - rows[j] + all;
            squares += centred * centred;
            trace += i == j ? centred : 0.0;
        }
    const double least = 1.0 / static_cast<double>(k - 1);
    return squares > 0.0 ? std::clamp(trace * trace * least / squares, least, 1.0) : 1.0;
}

} // namespace

Mean meanOf(const std::vector<double>& values) {
    Mean result;
    const auto n = static_cast<double>(values.size());
    result.mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    if (values.size() < 2)
        return result;
    double squares = 0.0;
    for (const double value : values)
        squares += (value - result.mean) * (value - result.mean);
    result.deviation = std::sqrt(squares / (n - 1.0));
    result.half = tQuantile(0.95, n - 1.0) * result.deviation / std::sqrt(n);
    return result;
}

Variance analyse(const Thresholds& values, bool probabilities) {
    check(values);
    const size_t people = values.size(), conditions = values.front().size();
    const auto n = static_cast<double>(people), k = static_cast<double>(conditions);
    Variance result;
    double grand = 0.0;
    for (size_t c = 0; c < conditions; ++c) {
        std::vector<double> column;
        for (const auto& row : values)
            column.push_back(row[c]);
        result.means.push_back(meanOf(column));
        grand += result.means.back().mean / k;
    }
    double between = 0.0, persons = 0.0, within = 0.0;
    for (const Mean& mean : result.means)
        between += n * (mean.mean - grand) * (mean.mean - grand);
    for (const auto& row : values) {
        const double own = std::accumulate(row.begin(), row.end(), 0.0) / k;
        persons += k * (own - grand) * (own - grand);
        for (size_t c = 0; c < conditions; ++c)
            within += (row[c] - result.means[c].mean) * (row[c] - result.means[c].mean);
    }
    result.repeated = fTest(between, k - 1.0, std::max(0.0, within - persons), (k - 1.0) * (n - 1.0));
    result.independent = fTest(between, k - 1.0, within, k * (n - 1.0));
    result.epsilon = sphericity(values, result.means);
    result.correctedP = fTail(result.repeated.f, result.epsilon * result.repeated.between,
                              result.epsilon * result.repeated.within);
    result.tukey = tukey(result.means, result.repeated, people, probabilities);
    result.tukeyIndependent = tukey(result.means, result.independent, people, probabilities);
    return result;
}

} // namespace touchstone::experiment

#pragma once
// How many people, and how many trials, a study needs: the whole experiment with simulated people, many
// times.

#include "experiment/people/ideal_observer.h"

#include <functional>
#include <string>
#include <vector>

namespace touchstone::experiment {

struct PowerRow {
    size_t people = 0, reversals = 0;
    double trials = 0.0; ///< mean, of a person in one condition
    double anova = 0.0;  ///< share of experiments in which the conditions differ, p < 0.05
    std::vector<double>
        told{}; ///< for each pair of conditions: the share in which Tukey's test tells them apart
    std::vector<double> deviation{}; ///< for each condition: mean standard deviation over people, levels
};

struct PowerPlan {
    std::vector<size_t> people{4, 6, 8, 12, 16, 24};
    std::vector<size_t> reversals{7, 11, 15};
    size_t experiments = 200; ///< for each row
    uint64_t seed = 0;
    PeopleSpread spread{};
    ObserverNoise noise{};
    Attention attention = Attention::Everything;
};

/// Of the conditions that `tables` are of; every staircase ends with as many averaged reversals as the
/// study's share of them. The same plan gives the same rows.
[[nodiscard]] std::vector<PowerRow> powerOf(std::vector<DifferenceTable>& tables, const PowerPlan& plan);

} // namespace touchstone::experiment

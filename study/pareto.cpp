#include "study/pareto.h"

#include "study/timing/interval.h"

#include <algorithm>

namespace touchstone::study {

namespace {

bool comparable(const ConfigurationResult& a, const ConfigurationResult& b) {
    return a.scene == b.scene && a.path == b.path && a.ablation == b.ablation && a.rateHz == b.rateHz &&
           a.truth == b.truth;
}

bool measured(const ConfigurationResult& configuration) {
    return configuration.errors.compared > 0 && configuration.step.value > 0.0;
}

/// Significantly: the intervals do not overlap.
bool cheaper(const Estimate& a, const Estimate& b) {
    return a.value < b.value && apart(a, b);
}

} // namespace

// Acyclic: a cycle would need equal errors all the way around, and `cheaper` is a strict order.
bool beats(const Estimate& cost, double error, const Estimate& otherCost, double otherError) {
    return error <= otherError && !cheaper(otherCost, cost) &&
           (error < otherError || cheaper(cost, otherCost));
}

void markPareto(std::span<ConfigurationResult> configurations) {
    for (ConfigurationResult& configuration : configurations)
        configuration.pareto =
            measured(configuration) &&
            std::none_of(configurations.begin(), configurations.end(), [&](const ConfigurationResult& other) {
                return comparable(configuration, other) && measured(other) &&
                       beats(other.step, felt(other.errors), configuration.step, felt(configuration.errors));
            });
}

} // namespace touchstone::study

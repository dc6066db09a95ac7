#include "study/pareto.h"

#include "study/timing/interval.h"

#include <algorithm>

namespace touchstone::study {

namespace {

bool comparable(const RungResult& a, const RungResult& b) {
    return a.scene == b.scene && a.path == b.path && a.ladder == b.ladder && a.rateHz == b.rateHz &&
           a.truth == b.truth;
}

bool measured(const RungResult& rung) {
    return rung.errors.compared > 0 && rung.step.value > 0.0;
}

/// Beyond doubt.
bool cheaper(const Estimate& a, const Estimate& b) {
    return a.value < b.value && apart(a, b);
}

} // namespace

// No cycles: nearness would have to be the same all the way around, and who is cheaper beyond doubt is
// ordered.
bool beats(const Estimate& cost, double error, const Estimate& otherCost, double otherError) {
    return error <= otherError && !cheaper(otherCost, cost) &&
           (error < otherError || cheaper(cost, otherCost));
}

void markPareto(std::span<RungResult> rungs) {
    for (RungResult& rung : rungs)
        rung.pareto =
            measured(rung) && std::none_of(rungs.begin(), rungs.end(), [&](const RungResult& other) {
                return comparable(rung, other) && measured(other) &&
                       beats(other.step, felt(other.errors), rung.step, felt(rung.errors));
            });
}

} // namespace touchstone::study

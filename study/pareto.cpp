#include "study/pareto.h"

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

bool beats(const RungResult& a, const RungResult& b) {
    const double cost = a.step.value - b.step.value, error = felt(a.errors) - felt(b.errors);
    return cost <= 0.0 && error <= 0.0 && (cost < 0.0 || error < 0.0);
}

} // namespace

void markPareto(std::span<RungResult> rungs) {
    for (RungResult& rung : rungs)
        rung.pareto =
            measured(rung) && std::none_of(rungs.begin(), rungs.end(), [&](const RungResult& other) {
                return comparable(rung, other) && measured(other) && beats(other, rung);
            });
}

} // namespace touchstone::study

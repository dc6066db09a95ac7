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

/// Cheaper beyond doubt.
bool cheaper(const RungResult& a, const RungResult& b) {
    return a.step.value < b.step.value && apart(a.step, b.step);
}

/// No cycles: nearness would have to be the same all the way around, and who is cheaper beyond doubt is
/// ordered.
bool beats(const RungResult& a, const RungResult& b) {
    const double nearness = felt(a.errors) - felt(b.errors);
    return nearness <= 0.0 && !cheaper(b, a) && (nearness < 0.0 || cheaper(a, b));
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

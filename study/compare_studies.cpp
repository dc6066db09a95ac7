#include "study/compare_studies.h"

#include "study/timing/interval.h"

#include <algorithm>

namespace touchstone::study {

namespace {

bool same(const RungResult& a, const RungResult& b) {
    return a.scene == b.scene && a.path == b.path && a.ladder == b.ladder && a.rung == b.rung &&
           a.rateHz == b.rateHz;
}

bool sideBySide(const RungResult& a, const RungResult& b) {
    return a.scene == b.scene && a.path == b.path && a.ladder == b.ladder && a.rateHz == b.rateHz;
}

std::string nameOf(const RungResult& rung) {
    return rung.scene + ", " + rung.ladder + ": " + rung.rung;
}

} // namespace

OrderKept compareOrder(const StudyResult& first, const StudyResult& second) {
    OrderKept kept;
    std::vector<std::pair<const RungResult*, const RungResult*>> both;
    for (const RungResult& a : first.rungs) {
        const auto b = std::find_if(second.rungs.begin(), second.rungs.end(),
                                    [&](const RungResult& other) { return same(a, other); });
        if (b == second.rungs.end()) {
            ++kept.onlyInOne;
            continue;
        }
        both.emplace_back(&a, &*b);
        kept.frontBoth += a.pareto && b->pareto ? 1 : 0;
        kept.frontOne += a.pareto != b->pareto ? 1 : 0;
        kept.errorsChanged += a.errors == b->errors ? 0 : 1;
    }
    kept.matched = both.size();
    kept.onlyInOne += second.rungs.size() - both.size();
    for (size_t i = 0; i < both.size(); ++i)
        for (size_t k = i + 1; k < both.size(); ++k) {
            const auto& [a1, a2] = both[i];
            const auto& [b1, b2] = both[k];
            if (!sideBySide(*a1, *b1))
                continue;
            ++kept.pairs;
            if (!apart(a1->step, b1->step))
                continue;
            ++kept.apart;
            const bool turned = (a1->step.value < b1->step.value) != (a2->step.value < b2->step.value);
            if (apart(a2->step, b2->step)) {
                ++kept.bothApart;
                kept.swappedApart += turned ? 1 : 0;
            }
            if (turned)
                kept.swapped.push_back(nameOf(*a1) + " and " + b1->rung);
        }
    return kept;
}

} // namespace touchstone::study

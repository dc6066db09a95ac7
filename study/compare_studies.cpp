#include "study/compare_studies.h"

#include "study/timing/interval.h"

#include <algorithm>

namespace touchstone::study {

namespace {

bool same(const ConfigurationResult& a, const ConfigurationResult& b) {
    return a.scene == b.scene && a.path == b.path && a.ablation == b.ablation &&
           a.configuration == b.configuration && a.rateHz == b.rateHz;
}

bool sideBySide(const ConfigurationResult& a, const ConfigurationResult& b) {
    return a.scene == b.scene && a.path == b.path && a.ablation == b.ablation && a.rateHz == b.rateHz;
}

std::string nameOf(const ConfigurationResult& configuration) {
    return configuration.scene + ", " + configuration.ablation + ": " + configuration.configuration;
}

} // namespace

OrderKept compareOrder(const StudyResult& first, const StudyResult& second) {
    OrderKept kept;
    std::vector<std::pair<const ConfigurationResult*, const ConfigurationResult*>> both;
    for (const ConfigurationResult& a : first.configurations) {
        const auto b = std::find_if(second.configurations.begin(), second.configurations.end(),
                                    [&](const ConfigurationResult& other) { return same(a, other); });
        if (b == second.configurations.end()) {
            ++kept.onlyInOne;
            continue;
        }
        both.emplace_back(&a, &*b);
        kept.frontBoth += a.pareto && b->pareto ? 1 : 0;
        kept.frontOne += a.pareto != b->pareto ? 1 : 0;
        kept.errorsChanged += a.errors == b->errors ? 0 : 1;
    }
    kept.matched = both.size();
    kept.onlyInOne += second.configurations.size() - both.size();
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
                kept.swapped.push_back(nameOf(*a1) + " and " + b1->configuration);
        }
    return kept;
}

} // namespace touchstone::study

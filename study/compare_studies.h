#pragma once
// Repeatability: compares the results of two studies.

#include "study/result/result.h"

namespace touchstone::study {

struct OrderKept {
    size_t matched = 0, onlyInOne = 0;  ///< configurations
    size_t pairs = 0;                   ///< of matched configurations of one scene, path and ablation
    size_t apart = 0;                   ///< pairs whose intervals do not overlap in the first study
    size_t bothApart = 0;               ///< of these, also in the second
    size_t swappedApart = 0;            ///< of `bothApart`: in the opposite order
    size_t frontBoth = 0, frontOne = 0; ///< configurations on the front in both studies; in only one
    size_t errorsChanged = 0;           ///< configurations whose errors are not bitwise equal
    std::vector<std::string> swapped;   ///< pairs apart in the first study that change places in the second
};

/// Orders by the medians of the steps.
[[nodiscard]] OrderKept compareOrder(const StudyResult& first, const StudyResult& second);

} // namespace touchstone::study

#pragma once
// Whether what one study found is found again by another.

#include "study/result/result.h"

namespace touchstone::study {

struct OrderKept {
    size_t matched = 0, onlyInOne = 0;  ///< configurations
    size_t pairs = 0;                   ///< of matched configurations of one scene, path and ablation
    size_t apart = 0;                   ///< of these: their intervals do not overlap in the first study
    size_t bothApart = 0;               ///< nor in the second
    size_t swappedApart = 0;            ///< of `bothApart`: in the other order
    size_t frontBoth = 0, frontOne = 0; ///< configurations on the front in both and in one of them only
    size_t errorsChanged = 0;           ///< configurations whose errors are not the same to the last bit
    std::vector<std::string> swapped;   ///< pairs apart in the first study that are in the other order
};

/// By the medians of their steps.
[[nodiscard]] OrderKept compareOrder(const StudyResult& first, const StudyResult& second);

} // namespace touchstone::study

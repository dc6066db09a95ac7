#include "workbench/timeline/min_max_pyramid.h"

#include <algorithm>
#include <utility>

namespace touchstone {

namespace {

void include(MinMax& all, const MinMax& more) {
    all.least = std::min(all.least, more.least);
    all.most = std::max(all.most, more.most);
}

} // namespace

MinMaxPyramid::MinMaxPyramid(std::vector<float> values) : values_(std::move(values)) {
    for (size_t below = values_.size(); below > kBranch; below = levels_.back().size()) {
        std::vector<MinMax> level((below + kBranch - 1) / kBranch);
        const auto entry = [&](size_t i) {
            return levels_.empty() ? MinMax{values_[i], values_[i]} : levels_.back()[i];
        };
        for (size_t i = 0; i < level.size(); ++i) {
            level[i] = entry(i * kBranch);
            for (size_t j = i * kBranch + 1; j < std::min(below, (i + 1) * kBranch); ++j)
                include(level[i], entry(j));
        }
        levels_.push_back(std::move(level));
    }
}

/// From both ends inwards: entries that do not fill a parent are taken one by one, then the same one level
/// higher.
MinMax MinMaxPyramid::over(size_t first, size_t last) const {
    MinMax all{values_[first], values_[first]};
    const auto entry = [&](size_t level, size_t i) {
        return level == 0 ? MinMax{values_[i], values_[i]} : levels_[level - 1][i];
    };
    for (size_t level = 0; first < last; ++level) {
        const bool top = level == levels_.size();
        while (first < last && (top || first % kBranch != 0))
            include(all, entry(level, first++));
        while (first < last && last % kBranch != 0)
            include(all, entry(level, --last));
        first /= kBranch;
        last /= kBranch;
    }
    return all;
}

} // namespace touchstone

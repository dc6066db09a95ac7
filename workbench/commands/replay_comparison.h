#pragma once
// `touchstone replay --compare`: a recording touched again with other settings, beside what was recorded.

#include "haptics/recording/replayer.h"
#include "workbench/figures/force_comparison.h"
#include "workbench/options/commands.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace touchstone {

struct ReplayComparison {
    std::string settings; ///< as typed
    ForceComparison figures;
};

/// One for each of `options.compare`; writes options.compareOut and options.plot where they are asked for.
/// `load` is called once for each scene and comparison. Throws Error.
[[nodiscard]] std::vector<ReplayComparison> compareReplay(const ReplayOptions& options,
                                                          const Replayer::Load& load);

[[nodiscard]] nlohmann::ordered_json comparisonsJson(const std::vector<ReplayComparison>& compared);
/// A table on standard output; nothing without a comparison.
void printComparisons(const std::vector<ReplayComparison>& compared);

} // namespace touchstone

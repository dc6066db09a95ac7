#pragma once
// The servo rates of [000 Table I] by the protocol that they were measured with: "rendering 3-D objects for
// at least 3 min", "repeated at least three times for each object".

#include "workbench/options/commands.h"

#include <nlohmann/json_fwd.hpp>

namespace touchstone {

/// Runs and prints it; every run of each object and method. Objects and methods take turns.
[[nodiscard]] nlohmann::ordered_json benchProtocol(const BenchOptions& options);

} // namespace touchstone

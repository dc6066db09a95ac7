#pragma once
// How long a distance field of a mesh takes to build, at the size of [002 §5.1].

#include "workbench/options/commands.h"

#include <nlohmann/json_fwd.hpp>

namespace touchstone {

/// Builds and prints them: 150³ nodes from 3,328 and from 11,858 triangles, in turns. `missed` counts those
/// whose median is above 0.5 s.
[[nodiscard]] nlohmann::ordered_json benchFields(const BenchOptions& options, size_t& missed);

} // namespace touchstone

#pragma once
// A model's contents, haptic properties, costs and problems.

#include "workbench/model/model.h"

#include <nlohmann/json.hpp>

namespace touchstone {

/// The output of `inspect --json` (docs/commands.md). Strokes the model and times the ticks on the calling
/// thread, whose float mode it sets; some 10 ms for each effect of the plan.
[[nodiscard]] nlohmann::ordered_json inspectionOf(const Model& model);

} // namespace touchstone

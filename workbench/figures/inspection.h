#pragma once
// What a model is, what it would feel like, what that costs, and what is wrong with it.

#include "workbench/model/model.h"

#include <nlohmann/json.hpp>

namespace touchstone {

/// What `inspect --json` writes (docs/commands.md). Strokes the model and times the ticks on the calling
/// thread, whose float mode it sets; some 10 ms for each effect of the plan.
[[nodiscard]] nlohmann::ordered_json inspectionOf(const Model& model);

} // namespace touchstone

#pragma once
// A model's contents, haptic properties, costs and problems.

#include "workbench/model/model.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>

namespace touchstone {

/// The output of `inspect --json` (docs/commands.md). Strokes the model and times the ticks on the calling
/// thread, whose float mode it sets; some 10 ms for each effect of the plan, at most `longestNs` ns for all
/// of them; no more than that for each program, and for the ticks of the stroke.
[[nodiscard]] nlohmann::ordered_json inspectionOf(const Model& model, int64_t longestNs = 2'000'000'000);

} // namespace touchstone

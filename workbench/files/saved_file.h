#pragma once

#include "workbench/readings/force_history.h"

#include <filesystem>
#include <string_view>

namespace touchstone {

/// Where the window saves what it shows: in the state folder's `saved`, named after what it is and the time.
/// Makes the folder; throws std::filesystem::filesystem_error.
[[nodiscard]] std::filesystem::path savedFile(std::string_view what, std::string_view ending);

/// The ticks of a chart, one a row: t,force,tangential,penetration,energy,step (s, N, N, m, J, s), contact,
/// recorded (0, 1). Throws Error.
void writeChart(const std::filesystem::path& file, const ForceHistory& history);

} // namespace touchstone

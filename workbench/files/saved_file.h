#pragma once

#include "workbench/readings/force_history.h"

#include <filesystem>
#include <string_view>

namespace touchstone {

/// Path for files that the window saves: in the state folder's `saved`, named by content and time. Creates
/// the folder; throws std::filesystem::filesystem_error.
[[nodiscard]] std::filesystem::path savedFile(std::string_view what, std::string_view ending);

/// The ticks of a chart, one per row: t,force,tangential,penetration,energy,step (s, N, N, m, J, s), contact,
/// recorded (0, 1). Throws Error.
void writeChart(const std::filesystem::path& file, const ForceHistory& history);

} // namespace touchstone

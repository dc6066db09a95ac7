#pragma once

#include "study/report/plots/figure.h"

#include <filesystem>
#include <string>

namespace touchstone::study {

/// Leaves NAME.gp and NAME.dat in `folder` and has `program` draw NAME.svg there, whole or not at all.
/// Returns what went wrong, with a remedy, or "". Throws Error where the folder cannot be written.
[[nodiscard]] std::string draw(const Figure& figure, const std::filesystem::path& folder,
                               const std::string& program = "gnuplot");

} // namespace touchstone::study

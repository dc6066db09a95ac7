#pragma once

#include "study/report/plots/figure.h"

#include <filesystem>
#include <string>

namespace touchstone::study {

/// Writes NAME.gp and NAME.dat to `folder` and runs `program` to draw NAME.svg there, replaced atomically.
/// Returns the problem with a remedy, or "". Throws Error where the folder cannot be written.
[[nodiscard]] std::string draw(const Figure& figure, const std::filesystem::path& folder,
                               const std::string& program = "gnuplot");

} // namespace touchstone::study

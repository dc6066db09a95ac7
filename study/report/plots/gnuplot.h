#pragma once

#include "study/report/plots/figure.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace touchstone::study {

enum class PlotFormat : uint8_t { Svg, Png };

/// Writes NAME.gp and NAME.dat to `folder` and runs `program` to draw NAME.svg there, or NAME.png (three
/// pixels for each one of the paper), replaced atomically. Returns the problem with a remedy, or "". Throws
/// Error where the folder cannot be written.
[[nodiscard]] std::string draw(const Figure& figure, const std::filesystem::path& folder,
                               const std::string& program = "gnuplot", PlotFormat format = PlotFormat::Svg);

} // namespace touchstone::study

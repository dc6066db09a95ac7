#pragma once
// Writes down what a study measured, and reads it again.

#include "study/result/result.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace touchstone::study {

/// One row a configuration; the unit stands in the column's name, numbers are as exact as in memory. The
/// rates and what the whole study has in common are in the JSON alone. Throws Error where the file cannot be
/// written.
void writeStudyCsv(const StudyResult& result, const std::filesystem::path& file);

/// Everything. What `readStudyJson` makes of it equals `result` to the bit (but for names that are not
/// UTF-8). Throws Error where the file cannot be written.
void writeStudyJson(const StudyResult& result, const std::filesystem::path& file);

/// Throws Error that names the file and the place in it where it is not what `writeStudyJson` writes.
[[nodiscard]] StudyResult readStudyJson(const std::filesystem::path& file);

/// What the shards of a study found, as one. Provenance is that of the first; `problems` tells where another
/// was measured on another machine or by another build, and which configurations came twice (the first one
/// counts).
[[nodiscard]] StudyResult mergeStudies(std::span<const StudyResult> shards);

struct PlotsWritten {
    std::vector<std::filesystem::path> files; ///< SVG
    std::vector<std::string> problems;        ///< with a remedy each
};
/// Pictures of a study, in DIR/plots: for each NAME.svg, and NAME.gp and NAME.dat out of which `gnuplot
/// NAME.gp` makes it again. What cannot be drawn is a problem told, a missing gnuplot too. Throws Error where
/// the folder cannot be written. `gnuplot`: the program to run.
PlotsWritten writeStudyPlots(const StudyResult& result, const std::filesystem::path& dir,
                             const std::string& gnuplot = "gnuplot");

} // namespace touchstone::study

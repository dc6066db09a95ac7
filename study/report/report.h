#pragma once
// Writes and reads the results of a study.

#include "study/result/result.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace touchstone::study {

/// One row per configuration; the column's name contains the unit, numbers have full precision. The rates,
/// the voxels and the provenance are in the JSON only. Throws Error where the file cannot be written.
void writeStudyCsv(const StudyResult& result, const std::filesystem::path& file);

/// Everything. `readStudyJson` restores `result` bitwise (except names that are not UTF-8). Throws Error
/// where the file cannot be written.
void writeStudyJson(const StudyResult& result, const std::filesystem::path& file);

/// Throws Error with the file and the place in it where it deviates from the format of `writeStudyJson`.
[[nodiscard]] StudyResult readStudyJson(const std::filesystem::path& file);

/// Merges the shards of a study. Provenance is that of the first; `problems` lists shards of another machine
/// or build, and duplicate configurations (the first one counts).
[[nodiscard]] StudyResult mergeStudies(std::span<const StudyResult> shards);

struct PlotsWritten {
    std::vector<std::filesystem::path> files; ///< SVG
    std::vector<std::string> problems;        ///< with a remedy each
};
/// Plots of a study, in DIR/plots: for each NAME.svg also NAME.gp and NAME.dat, from which `gnuplot NAME.gp`
/// redraws it. A plot that fails is reported in `problems`, a missing gnuplot too. Throws Error where the
/// folder cannot be written. `gnuplot`: the program to run.
PlotsWritten writeStudyPlots(const StudyResult& result, const std::filesystem::path& dir,
                             const std::string& gnuplot = "gnuplot");

} // namespace touchstone::study

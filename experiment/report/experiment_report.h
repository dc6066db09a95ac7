#pragma once
// What came out of a study: tables, figures and the paper's numbers beside them.

#include "experiment/people/person_session.h"
#include "experiment/people/power.h"
#include "experiment/statistics/variance.h"
#include "study/result/result.h"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone::experiment {

/// [004 Tables 1 and 2]. Intervals are of the mean, in segments; none for the pilots, two people each.
struct PaperResult {
    std::string_view name;
    double degrees;                    ///< between neighbouring segments
    double segments = 0.0, half = 0.0; ///< Table 1; 0: not printed
};
inline constexpr std::array<PaperResult, 6> kPaperResults{{{"C1", 0.5, 104.1, 35.32},
                                                           {"C2", 3.4, 16.3, 1.99},
                                                           {"C3", 0.2, 257.3, 63.20},
                                                           {"C4", 3.5, 15.6, 3.85},
                                                           {"P1", 14.8},
                                                           {"P2", 0.2}}};
/// Null for a condition of another study.
[[nodiscard]] const PaperResult* paperResult(const StudyPlan& plan, const Condition& condition);

struct ConditionResult {
    size_t condition = 0;
    std::vector<double> thresholds{}; ///< of those who have one
    Mean mean{};                      ///< of them
    size_t begun = 0, done = 0;       ///< people
    size_t trials = 0, right = 0;
    std::optional<double> observer{}; ///< the ideal observer's own threshold, without a staircase
};

struct ExperimentResult {
    StudyPlan plan{};
    std::vector<ConditionResult> conditions{};
    std::vector<size_t> compared{}; ///< conditions in `variance`: staircases that are no pilots
    std::vector<size_t> complete{}; ///< people (index into the sessions) with a threshold in each of these
    std::optional<Variance> variance{};
    std::string whyNoVariance{};
    std::vector<PowerRow> power{};
    std::vector<std::string> problems{};
};

/// Of sessions of one study. Throws Error where there is none, or where two are of different studies.
[[nodiscard]] ExperimentResult evaluate(const std::vector<PersonSession>& sessions);

/// Degrees between neighbouring segments of a condition's polygon; NaN where its level is no number of
/// segments.
[[nodiscard]] double degreesAt(const Condition& condition, double level);

[[nodiscard]] std::string describe(const ExperimentResult& result);
[[nodiscard]] nlohmann::ordered_json toJson(const ExperimentResult& result);
/// One line for each trial: columns are in docs/files.md.
[[nodiscard]] std::string trialsCsv(const std::vector<PersonSession>& sessions);
[[nodiscard]] std::string thresholdsCsv(const std::vector<PersonSession>& sessions);

/// Writes trials.csv, thresholds.csv, report.json, report.txt and the plots to `folder`. Returns what could
/// not be drawn. Throws Error where the folder cannot be written.
std::vector<std::string> writeReport(const ExperimentResult& result,
                                     const std::vector<PersonSession>& sessions,
                                     const std::filesystem::path& folder, const study::Provenance& where);

} // namespace touchstone::experiment

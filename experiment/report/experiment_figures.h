#pragma once
// Figures 12 and 13 of [004], and the power of a study, as input to gnuplot.

#include "experiment/report/experiment_report.h"
#include "study/report/plots/figure.h"

namespace touchstone::experiment {

/// Fig. 12: levels over trials of one person, a panel for each condition. Without a name where there is no
/// trial.
[[nodiscard]] study::Figure staircaseFigure(const PersonSession& session, const study::Provenance& where);
/// Fig. 13: means and 95 % intervals, each person's threshold, the paper's beside. Letters: conditions that
/// share one are not told apart by Tukey's test at 0.05. Without a name where nobody has a threshold.
[[nodiscard]] study::Figure thresholdFigure(const ExperimentResult& result, const study::Provenance& where);
/// Shares over the number of people. Without a name where there are none.
[[nodiscard]] study::Figure powerFigure(const ExperimentResult& result, const study::Provenance& where);

/// For each condition in `compared` the letters of its groups: "a", "ab".
[[nodiscard]] std::vector<std::string> groupLetters(const Variance& variance);

} // namespace touchstone::experiment

#pragma once
// Curves over a logarithmic axis, distinguished by colour (the quantity) and mark (the subject).

#include "study/report/plots/figure.h"

namespace touchstone::study {

struct SeriesPoint {
    double x, y, low, high; ///< low and high: the interval of y; equal where there is none
};

struct Series {
    std::string colourName, markName; ///< series of one name share a colour, or a mark; all equal: one legend
    std::vector<SeriesPoint> points;  ///< sorted by x in this function
    bool floor = false;               ///< dashed and grey, shared by all: the baseline
};

/// A vertical line at x = `at`.
struct Threshold {
    double at;
    std::string name, text; ///< above the line; in the legend
};

struct SeriesPlot {
    std::string name;
    Paper paper;
    std::string xWords, yWords;
    std::string colourTitle, markTitle; ///< of the parts of the legend
    std::vector<Series> series;
    std::vector<Threshold> thresholds;
    std::string thresholdTitle;
    double minY = 0.0; ///< smaller values are drawn as exact
    std::string leastText;
};

/// From all series that have a point; an empty name if there is nothing to plot.
[[nodiscard]] Figure figureOf(SeriesPlot plot, const Provenance& where);

} // namespace touchstone::study

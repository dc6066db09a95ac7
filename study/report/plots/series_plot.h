#pragma once
// Curves over a logarithmic axis, told apart by colour (what is compared) and mark (on what).

#include "study/report/plots/figure.h"

namespace touchstone::study {

struct SeriesPoint {
    double x, y, low, high; ///< low and high: the interval of y; alike where there is none
};

struct Series {
    std::string colourName, markName; ///< series of one name share a colour, or a mark; all alike: one key
    std::vector<SeriesPoint> points;  ///< sorted by x here
    bool floor = false;               ///< drawn dashed and grey, one for all: what it is measured against
};

/// A line across the plot at `at` on the axis of x.
struct Threshold {
    double at;
    std::string name, text; ///< above the line; in the key
};

struct SeriesPlot {
    std::string name;
    Paper paper;
    std::string xWords, yWords;
    std::string colourTitle, markTitle; ///< of the key's parts
    std::vector<Series> series;
    std::vector<Threshold> thresholds;
    std::string thresholdTitle;
    double minY = 0.0; ///< what is less is drawn as exact
    std::string leastText;
};

/// Of all series that have a point; nothing to draw gives an empty name.
[[nodiscard]] Figure figureOf(SeriesPlot plot, const Provenance& where);

} // namespace touchstone::study

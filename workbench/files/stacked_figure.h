#pragma once
// Curves over one axis of time, in panels one above the other.

#include "study/report/plots/figure.h"

#include <string>
#include <vector>

namespace touchstone {

struct StackedCurve {
    std::string title;
    size_t column = 2; ///< of the data, from 1; time is the first
    size_t mark = 0;   ///< study::markOf: its colour
};
struct StackedPanel {
    std::string axis;             ///< "force, N"
    double low = 0.0, high = 1.0; ///< of the axis
    std::vector<StackedCurve> curves;
};
struct StackedFigure {
    std::string name; ///< of its files
    std::string title, subtitle;
    std::string timeAxis;          ///< "time, s"
    double begin = 0.0, end = 1.0; ///< of that axis
    std::vector<StackedPanel> panels;
    std::string data; ///< rows of columns, as gnuplot reads them
};

/// As a figure for gnuplot: a page of 960 pixels' width.
[[nodiscard]] study::Figure stacked(StackedFigure figure, const study::Provenance& where);

} // namespace touchstone

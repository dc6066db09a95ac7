#pragma once
// Shared by the plots of a study: paper, colours, logarithmic axes, gnuplot strings.

#include "study/result/result.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone::study {

/// A plot as input to gnuplot. `script` reads `name`.dat and writes the file in its variable `out`, by
/// default `name`.svg: SVG, or PNG with `png` pixels for each one of the paper, if that variable exists.
struct Figure {
    std::string name, script, data;
};

/// Colour and shape, each of which identifies a series by itself (colours of Okabe and Ito, gnuplot's point
/// types).
struct Mark {
    std::string_view colour;
    int point;
};
[[nodiscard]] Mark markOf(size_t series);

/// In single quotes, which gnuplot does not interpret; control characters become blanks.
[[nodiscard]] std::string inQuotes(std::string_view text);
/// Lower-case ASCII letters, digits and '_', at most 60.
[[nodiscard]] std::string slug(std::string_view text);
/// Up to four significant digits: "0.05", "12.3", "4096".
[[nodiscard]] std::string brief(double value);
/// Text truncated to `most` characters with an ellipsis, at a UTF-8 boundary.
[[nodiscard]] std::string cut(std::string_view text, size_t most);
/// Width of a text in our font at `size`, pixels; an approximation that does not underestimate our texts.
[[nodiscard]] double textWidth(std::string_view text, double size);

/// Position of the axes on the paper, pixels from its lower left corner.
struct Area {
    double left, right, bottom, top;
};

/// Paper of `width` by `height` pixels: a title, a line below it, and at the foot `notes` above the place and
/// date of the measurement.
struct Paper {
    double width = 1180.0, height = 720.0;
    Area area{90.0, 770.0, 100.0, 640.0};
    std::string title, subtitle;
    std::vector<std::string> notes; ///< one per line, at the foot
};
[[nodiscard]] std::string openPaper(const std::string& name, const Paper& paper, const Provenance& where);
/// `set label` at a position on the paper. `style`: further gnuplot options ("right", "tc rgb …").
[[nodiscard]] std::string labelAt(const Paper& paper, double x, double y, std::string_view text,
                                  std::string_view style = "", double size = 12.0);
/// A single mark, for a legend.
[[nodiscard]] std::string markAt(const Paper& paper, double x, double y, const Mark& mark);

/// A logarithmic axis. Values below `low` are drawn in a separate band under it, if enabled.
struct LogAxis {
    double low = 1.0, high = 10.0;
    bool band = false;   ///< band below `low` for exact values
    std::string bandTic; ///< its label: "exact"

    /// Covers all positive `values` and at least half a decade, with ends at steps of 1, 2, 5.
    static LogAxis around(const std::vector<double>& values, double minLow = 0.0);
    /// The plotted value: below `low`, a position in the band.
    [[nodiscard]] double place(double value) const;
    [[nodiscard]] double bottom() const; ///< start of the axis, below its band
    /// 0 at the start, 1 at the end.
    [[nodiscard]] double fraction(double value) const;
    /// `set …range`, `set logscale`, `set …tics` for "x" or "y".
    [[nodiscard]] std::string script(char axis) const;
};

} // namespace touchstone::study

#pragma once
// What the plots of a study share: paper, colours, logarithmic axes, text that gnuplot takes as it is.

#include "study/result/result.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone::study {

/// A picture before gnuplot has drawn it. `script` reads `name`.dat and writes the file that its variable
/// `out` names, `name`.svg where it has none.
struct Figure {
    std::string name, script, data;
};

/// By colour and by shape, so that either alone tells series apart (colours of Okabe and Ito, gnuplot's
/// point types).
struct Mark {
    std::string_view colour;
    int point;
};
[[nodiscard]] Mark markOf(size_t series);

/// In single quotes, as gnuplot takes a text without reading anything into it; control characters are blanks.
[[nodiscard]] std::string inQuotes(std::string_view text);
/// Small ASCII letters, digits and '_', no longer than 60.
[[nodiscard]] std::string slug(std::string_view text);
/// Up to four digits that count: "0.05", "12.3", "4096".
[[nodiscard]] std::string brief(double value);
/// Text that gnuplot may not end: cut to `most` characters with an ellipsis, at a letter of UTF-8.
[[nodiscard]] std::string cut(std::string_view text, size_t most);
/// Pixels that a text takes in our type at `size`, about; never too few for what we write.
[[nodiscard]] double textWidth(std::string_view text, double size);

/// Where the axes stand on the paper, pixels from its lower left corner.
struct Area {
    double left, right, bottom, top;
};

/// Paper of `width` by `height` pixels, a title with a line below it, and where and when it was measured at
/// the foot with `note` above.
struct Paper {
    double width = 1180.0, height = 720.0;
    Area area{90.0, 770.0, 100.0, 640.0};
    std::string title, subtitle;
    std::vector<std::string> notes; ///< one a line, at the foot
};
[[nodiscard]] std::string openPaper(const std::string& name, const Paper& paper, const Provenance& where);
/// `set label` at a place of the paper. `style`: more of gnuplot's words ("right", "tc rgb …").
[[nodiscard]] std::string labelAt(const Paper& paper, double x, double y, std::string_view text,
                                  std::string_view style = "", double size = 12.0);
/// A mark alone, for a key.
[[nodiscard]] std::string markAt(const Paper& paper, double x, double y, const Mark& mark);

/// A logarithmic axis. Values below `low` are drawn in a band of their own under it where there is one.
struct LogAxis {
    double low = 1.0, high = 10.0;
    bool band = false;   ///< room below `low` for what is exact
    std::string bandTic; ///< what stands beside it: "exact"

    /// To hold all positive `values`, at least half a decade, ends on steps of 1, 2, 5.
    static LogAxis around(const std::vector<double>& values, double minLow = 0.0);
    /// What gnuplot is to draw for a value: below `low`, a place in the band.
    [[nodiscard]] double place(double value) const;
    [[nodiscard]] double bottom() const; ///< where the axis begins, below its band
    /// 0 at the beginning, 1 at the end.
    [[nodiscard]] double fraction(double value) const;
    /// `set …range`, `set logscale`, `set …tics` for "x" or "y".
    [[nodiscard]] std::string script(char axis) const;
};

} // namespace touchstone::study

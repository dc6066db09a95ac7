#pragma once
// Where numbers go beside points so that none lies on another.

#include <vector>

namespace touchstone::study {

struct PlacedLabel {
    double x, y; ///< centre, pixels
    bool leader; ///< so far from its point that a line must lead there
};

/// A rectangle or, without extent, a point to keep clear of.
struct Obstacle {
    double x, y, halfWidth = 0.0, halfHeight = 0.0;
};

/// For each of `anchors` a place for a label of the given half extents in 0..width x 0..height, clear of the
/// other labels and, where that can be had, of all `obstacles`. Deterministic, in the order given.
[[nodiscard]] std::vector<PlacedLabel> placeLabels(const std::vector<Obstacle>& anchors,
                                                   const std::vector<Obstacle>& obstacles, double halfWidth,
                                                   double halfHeight, double width, double height);

} // namespace touchstone::study

#pragma once
// Places number labels beside points without overlap.

#include <vector>

namespace touchstone::study {

struct PlacedLabel {
    double x, y; ///< centre, pixels
    bool leader; ///< far enough from its point to need a leader line
};

/// A rectangle or, without extent, a point to keep clear of.
struct Obstacle {
    double x, y, halfWidth = 0.0, halfHeight = 0.0;
};

/// A place for a label of the given half extents at each of `anchors`, in 0..width x 0..height, clear of the
/// other labels and, where possible, of all `obstacles`. Deterministic, in the given order.
[[nodiscard]] std::vector<PlacedLabel> placeLabels(const std::vector<Obstacle>& anchors,
                                                   const std::vector<Obstacle>& obstacles, double halfWidth,
                                                   double halfHeight, double width, double height);

} // namespace touchstone::study

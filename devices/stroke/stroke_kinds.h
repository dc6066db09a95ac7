#pragma once
// The strokes of the simulated hand: the curve of each, and how the hand moves along it.

#include "devices/stroke/laid_curve.h"
#include "devices/stroke/stroke_library.h"
#include "devices/stroke/stroke_motion.h"

#include <glm/glm.hpp>

#include <array>
#include <span>
#include <string_view>
#include <vector>

namespace touchstone {

/// m over the surface, before and after; smaller where another part of the model is above.
inline constexpr std::array kHovers{0.008, 0.002, 0.0005};

/// Parameters of a stroke: speed and depth as requested, the depth as limited by the model, and the hover
/// height.
struct StrokeTold {
    double speed = 0.0, depth = 0.0;
    double hover = kHovers[0];
};

/// A stroke of the table.
struct StrokeKind {
    StrokeInfo info;
    double reach = 0.0; ///< m from the curve's middle, at full size
    /// In m in the site's view; null: it stays on one point.
    std::vector<glm::dvec2> (*draw)(double reach) = nullptr;
    void (*move)(StrokeMotion&, const LaidCurve&, const StrokeTold&) = nullptr; ///< null: the tour
    bool acrossEdge = false; ///< on LaidCurve::acrossEdge; along its own curve where there is no edge
};

/// In the order in which they are listed.
[[nodiscard]] std::span<const StrokeKind> strokeKinds();
/// Null for an unknown name.
[[nodiscard]] const StrokeKind* findKind(std::string_view name);

} // namespace touchstone

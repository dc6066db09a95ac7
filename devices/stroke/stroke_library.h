#pragma once
// The named strokes of the simulated hand.

#include "devices/stroke/stroke_path.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace touchstone {

/// A stroke and its purpose.
struct StrokeInfo {
    std::string_view name;
    std::string_view meaning; ///< one line for --help and tooltips
    double speed;             ///< m/s, the fastest on the surface (press, tap, hold: towards it)
    double depth;             ///< m under the surface
};

/// Where on the model, device frame.
struct StrokePlace {
    glm::dvec3 point{0.0};  ///< m, on the surface or near it
    glm::dvec3 normal{0.0}; ///< out of the surface; need not be unit
    bool operator==(const StrokePlace&) const = default;
};

struct StrokeRequest {
    std::string name = "tour";
    double speed = 0.0; ///< m/s, as StrokeInfo::speed; 0: the stroke's own
    double depth = 0.0; ///< m; 0: the stroke's own
    /// Around the point touched last; without it (and where the model has no surface there), near the centre
    /// of what faces `front`. `tour` covers the whole model and `edge` uses the sharpest edge, whatever the
    /// place.
    std::optional<StrokePlace> place = std::nullopt;
    glm::dvec3 front{0.0, 0.0, 1.0}; ///< towards the viewer, need not be unit

    bool operator==(const StrokeRequest&) const = default;
};

inline constexpr double kSlowestStroke = 0.001, kFastestStroke = 1.0;      ///< m/s
inline constexpr double kShallowestStroke = 0.0001, kDeepestStroke = 0.01; ///< m

[[nodiscard]] std::span<const StrokeInfo> strokeInfos();
/// Null for an unknown name.
[[nodiscard]] const StrokeInfo* findStroke(std::string_view name);
/// The problem with the name, with the known names; empty: none.
[[nodiscard]] std::string strokeProblem(std::string_view name);

/// Lays the stroke onto the model as `deviceFromScene` places it: a closed periodic path that starts in the
/// air over the surface, descends, strokes and lifts off. Position, velocity and acceleration are continuous.
/// The speed nowhere exceeds the stroke's, except in the air above the surface, up to 0.08 m/s. Where the
/// scene's animation moves the part under the path, the path moves with it (StrokePath::positionIn) and
/// avoids what the other parts sweep over.
///
/// The hand is nowhere farther than 1.5 times the depth from a point proxy that follows it, which is checked
/// before the path is returned. Curves shrink until there is surface without gaps, steps and walls under all
/// of them; where even the smallest fails (wires), the hand presses a single point, finally at less depth.
/// The depth is at most a tenth of the model's diagonal. Any thread but the servo's; deterministic; time
/// grows with the triangles (0.1 to 0.5 s per million). Throws Error for an unknown name, a number out of
/// range, a model without a triangle to touch, and where no point can be pressed without going deeper.
[[nodiscard]] StrokePath layStroke(const Scene& scene, const Similarity& deviceFromScene,
                                   const StrokeRequest& request);
/// The same over triangles given by their corners, three each, in the device frame.
[[nodiscard]] StrokePath layStroke(std::span<const glm::dvec3> corners, const StrokeRequest& request);

} // namespace touchstone

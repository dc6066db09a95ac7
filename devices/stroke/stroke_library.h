#pragma once
// The strokes that the simulated hand knows, by name.

#include "devices/stroke/stroke_path.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace touchstone {

/// A stroke and what a person would do it with.
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
    /// Around the point touched last; without it (and where the model has nothing there) near the middle of
    /// what faces `front`. `tour` goes over the whole model and `edge` to the sharpest edge, wherever that
    /// is.
    std::optional<StrokePlace> place = std::nullopt;
    glm::dvec3 front{0.0, 0.0, 1.0}; ///< towards the viewer, need not be unit

    bool operator==(const StrokeRequest&) const = default;
};

inline constexpr double kSlowestStroke = 0.001, kFastestStroke = 1.0;      ///< m/s
inline constexpr double kShallowestStroke = 0.0001, kDeepestStroke = 0.01; ///< m

[[nodiscard]] std::span<const StrokeInfo> strokeInfos();
/// Null where there is none of this name.
[[nodiscard]] const StrokeInfo* findStroke(std::string_view name);
/// What is wrong with the name, with those that there are; empty: nothing.
[[nodiscard]] std::string strokeProblem(std::string_view name);

/// Lays the stroke onto the model as `deviceFromScene` places it: a closed path that begins in the air over
/// the surface, comes down, strokes and lifts off again, for ever. Position, velocity and acceleration are
/// continuous and the speed is nowhere above the stroke's, but in the air above the surface up to 0.08 m/s.
/// Where the scene's animation moves the part that it is laid on the path rides on it
/// (StrokePath::positionIn), and keeps out of what the other parts sweep over.
///
/// The hand is nowhere farther than 1.5 times the depth from a point proxy that follows it, which is checked
/// before the path is returned. Curves become smaller until they find surface without gaps, steps and walls
/// under all of them; where even the smallest does not (wires), the hand presses a single place, at the last
/// less deep. The depth is at most a tenth of the model's diagonal. Any thread, not the servo's;
/// deterministic; time grows with the triangles (0.1 to 0.5 s a million). Throws Error for a name or a number
/// that cannot be, where there is no triangle to touch, and where no place can be pressed without going
/// deeper.
[[nodiscard]] StrokePath layStroke(const Scene& scene, const Similarity& deviceFromScene,
                                   const StrokeRequest& request);
/// The same over triangles given by their corners, three each, in the device frame.
[[nodiscard]] StrokePath layStroke(std::span<const glm::dvec3> corners, const StrokeRequest& request);

} // namespace touchstone

#pragma once
// What the arc finger feels in the plane [004 §4, §5]: force and contact location, each with or without
// shading.

#include "haptics/finger/tactile_shading.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace touchstone {

/// A circle's top, solid inside: the mathematically correct reference of [004 §5]. Its topmost point is the
/// origin of the plane.
struct SmoothArc {
    double radius = 0.1;  ///< m
    double angle = 0.902; ///< rad, symmetric about the top; beyond it nothing is touched

    [[nodiscard]] glm::dvec2 centre() const noexcept { return {0.0, -radius}; }
    /// The point at `at` rad from the top, clockwise.
    [[nodiscard]] glm::dvec2 point(double at) const noexcept;
};
/// Vertices on the arc, `segments` equal edges from left to right. Throws Error for no segment.
[[nodiscard]] Polyline polygonOf(const SmoothArc& arc, size_t segments);

/// Where the direction of the force comes from.
enum class PlanarForce : uint8_t {
    Facets, ///< the polygon's own
    Shaded, ///< interpolated vertex normals (Morgenbesser and Srinivasan), with the polygon's depth
    Bezier  ///< the line of tactile shading, depth and direction
};
inline constexpr std::array<std::string_view, 3> kPlanarForceNames{"facets", "shaded", "bezier"};
/// What the contact location display shows.
enum class PlanarLocation : uint8_t {
    Held,   ///< the middle of the pad
    Facets, ///< the contact with the polygon
    Bezier  ///< tactile shading
};
inline constexpr std::array<std::string_view, 3> kPlanarLocationNames{"held", "facets", "bezier"};

struct PlanarRendering {
    PlanarForce force = PlanarForce::Facets;
    PlanarLocation location = PlanarLocation::Held;
    TangentStep step = TangentStep::AsPublished;
    double stiffness = 600.0; ///< N/m
};

/// A surface to touch: a polyline, or a smooth arc, on which all renderings but a held location are one.
/// Immutable, read by any thread.
class PlanarSurface {
  public:
    explicit PlanarSurface(Polyline line) : line_(std::move(line)) { findNormals(); }
    explicit PlanarSurface(const SmoothArc& arc) : arc_(arc) {}

    [[nodiscard]] const Polyline* polyline() const noexcept { return line_ ? &*line_ : nullptr; }
    [[nodiscard]] const SmoothArc* arc() const noexcept { return arc_ ? &*arc_ : nullptr; }
    /// Unit normal at a polyline's point: of the mean of its edges.
    [[nodiscard]] const glm::dvec2& normalAt(size_t point) const noexcept { return normals_[point]; }

  private:
    void findNormals();

    std::optional<Polyline> line_;
    std::optional<SmoothArc> arc_;
    std::vector<glm::dvec2> normals_;
};

/// One finger on one surface, which outlives it. One thread; a step allocates nothing and does not throw.
class PlanarTouch {
  public:
    explicit PlanarTouch(const PlanarSurface& surface, const PlanarRendering& rendering = {},
                         const ArcFinger& finger = {}) noexcept;

    struct Felt {
        bool touching = false;
        glm::dvec2 force{0.0};  ///< N
        glm::dvec2 normal{0.0}; ///< of the force, into free space
        double depth = 0.0;     ///< m
        double location = 0.0;  ///< m along the pad from its middle: what the display shows
        glm::dvec2 point{0.0};  ///< m, on the polygon or the arc
    };
    /// The finger at its next pose. A pose that is not finite changes nothing and gives no force.
    Felt step(const FingerPose& pose) noexcept;
    /// Begins anew, as after a jump.
    void forget() noexcept;

  private:
    /// Contact of the finger's circle with edges or vertices; `depth` is negative in free space.
    struct Contact {
        bool found = false;
        size_t edge = 0;
        double along = 0.0; ///< 0..1 on the edge
        glm::dvec2 point{0.0}, normal{0.0};
        double depth = 0.0;
    };
    [[nodiscard]] Contact nearest(const glm::dvec2& centre, const Contact* apart) const noexcept;
    Felt onArc(const SmoothArc& arc, const FingerPose& pose) const noexcept;
    Felt onPolyline(const FingerPose& pose) noexcept;

    const PlanarSurface& surface_;
    PlanarRendering rendering_;
    ArcFinger finger_;
    std::optional<TactileShading> shading_;
};

} // namespace touchstone

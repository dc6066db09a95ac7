#pragma once
// The camera: pure arithmetic, no Vulkan. Everything is in the workspace frame, metres, right-handed, y up.

#include "engine/math/similarity.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <string_view>

namespace touchstone {

/// A ray in the workspace; `direction` is unit.
struct Ray {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0, 0.0, -1.0};
};

/// The sides of the workspace; front is +z, where the user sits.
enum class Side : uint8_t { Front, Back, Right, Left, Top, Bottom };
inline constexpr std::array<std::string_view, 6> kSideNames{"front", "back", "right",
                                                            "left",  "top",  "bottom"};

/// Looks at `target` from `distance` away. yaw turns about the workspace's y axis, pitch lifts the eye; at
/// yaw = pitch = 0 the eye is on the +z side, where the user of a desktop device sits, and x points right.
/// Plain data, any thread.
struct OrbitCamera {
    glm::dvec3 target{0.0};
    double distance = 0.4;            ///< m, > 0
    double yaw = 0.0;                 ///< rad, positive moves the eye to the right
    double pitch = 0.0;               ///< rad, positive moves the eye up; kept within ±kMaxPitch
    double fovY = 0.6108652381980153; ///< rad, full vertical angle: 35°, a short telephoto lens
    bool orthographic = false; ///< shows at the target what the perspective shows there, and all in its size
    double sceneRadius = 0.13; ///< m, radius around `target` that near and far planes enclose

    static constexpr double kMaxPitch =
        1.5707963267948966; ///< rad, 90°: straight from above, where yaw determines the right axis

    /// The first view of a model: from the front right and above, so that flat models are not seen edge-on.
    [[nodiscard]] static OrbitCamera threeQuarter(const Bounds& bounds, double aspect);

    [[nodiscard]] glm::dvec3 eye() const;
    [[nodiscard]] glm::dvec3 forward() const; ///< unit, from the eye to the target
    [[nodiscard]] glm::dvec3 right() const;   ///< unit
    [[nodiscard]] glm::dvec3 up() const;      ///< unit

    [[nodiscard]] double nearPlane() const; ///< m before the eye; > 0 in a perspective
    [[nodiscard]] double farPlane() const;  ///< m

    [[nodiscard]] glm::dmat4 viewFromWorkspace() const;
    /// Depth 0 at the near plane and 1 at the far plane, y up (the renderer flips for Vulkan).
    [[nodiscard]] glm::dmat4 clipFromView(double aspect) const;

    /// Straight from one side; target and distance stay.
    void lookFrom(Side side);
    /// Turns by angles in rad.
    void orbit(double deltaYaw, double deltaPitch);
    /// Translates target and eye by a displacement in pixels (x right, y down) of an image `heightPixels`
    /// high, such that a point at the target's depth follows the pointer.
    void pan(const glm::dvec2& pixels, double heightPixels);
    /// Multiplies the distance; factor < 1 moves closer. Bounded to 1e-2..1e3 scene radii.
    void zoom(double factor);
    /// Shows the whole box from the current direction, in an image of this aspect (width / height). An empty
    /// or degenerate box keeps the camera usable.
    void frame(const Bounds& bounds, double aspect = 16.0 / 9.0);

    /// The ray from the eye, in an orthographic view from the near plane, through a pixel position (x right,
    /// y down from the upper left corner of the image, in pixels).
    [[nodiscard]] Ray rayThroughPixel(const glm::dvec2& pixel, const glm::dvec2& imageSize) const;
    /// A pointer movement in pixels (x right, y down) as a displacement in the plane parallel to the image
    /// through `at`: metres in the workspace. Points behind the eye are moved to the near plane.
    [[nodiscard]] glm::dvec3 viewPlaneDisplacement(const glm::dvec2& pixels, double heightPixels,
                                                   const glm::dvec3& at) const;
    /// Pixel position of a workspace point; z is the depth along the view axis in m (negative: behind the
    /// eye).
    [[nodiscard]] glm::dvec3 pixelOf(const glm::dvec3& point, const glm::dvec2& imageSize) const;
};

} // namespace touchstone

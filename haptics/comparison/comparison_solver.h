#pragma once
// The contact models that exist to be compared with the virtual proxy, behind one interface: what
// ProxySolver offers to the stages after it.

#include "haptics/comparison/neighbourhood_watch.h"
#include "haptics/comparison/ray_proxy.h"
#include "haptics/settings/haptic_settings.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <variant>

namespace touchstone {

/// True where `settings` name one of them and `scene` has what it needs, and meshes only: else the tick is
/// ProxySolver's.
[[nodiscard]] bool comparisonIsReady(const HapticScene& scene, const HapticSettings& settings) noexcept;

/// One device in one tick, solved by the model that the settings name. They know the triangles of meshes and
/// no other shape.
class ComparisonSolver {
  public:
    /// What the objects' own motion does to the proxy before the solve (moving_obstacles.h).
    static void followObjects(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                              DeviceState& state, uint32_t& flags) noexcept;

    ComparisonSolver(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                     DeviceState& state, SolveResult& rest) noexcept;

    /// Places the proxy in the first tick; false while the HIP is inside a body.
    [[nodiscard]] bool begin() noexcept;
    /// The solve without friction goes on from `place`, where it ended in the last tick.
    void resumeFrom(const glm::dvec3& place) noexcept;
    void moveTowards(const glm::dvec3& goal) noexcept;
    void dropTowards(const glm::dvec3& goal) noexcept;
    /// The way to a place starts where the proxy stood, for those that can be put anywhere.
    void startAt(const glm::dvec3& place) noexcept;
    void placeAt(const glm::dvec3& place) noexcept;
    [[nodiscard]] bool slideOnFacet(const glm::dvec3&) noexcept { return false; }
    [[nodiscard]] bool touchesAt(const glm::dvec3&) noexcept { return true; }
    /// Back to a place where a solve for `hip` ended. True where it is on the surface.
    [[nodiscard]] bool returnTo(const glm::dvec3& place, const glm::dvec3& hip) noexcept;
    void settleClearance() noexcept { state_.clearance = 0.0; } // a point is clear of nothing

  private:
    DeviceState& state_;
    std::variant<NeighbourhoodWatch, RayProxy<double>, RayProxy<float>> solver_;
};

/// Drops from the proxy what a comparison solver left in it, before ProxySolver takes over.
void leaveComparison(const HapticScene& scene, ObjectMotions motions, DeviceState& state) noexcept;

} // namespace touchstone

#pragma once
// The comparison solvers: contact models for comparison with the virtual proxy, behind the interface that
// ProxySolver offers to the later stages.

#include "haptics/comparison/neighbourhood_watch.h"
#include "haptics/comparison/ray_proxy.h"
#include "haptics/settings/haptic_settings.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <variant>

namespace touchstone {

/// True where `settings` select one of them and `scene` has its data and only meshes: else ProxySolver solves
/// the tick.
[[nodiscard]] bool comparisonIsReady(const HapticScene& scene, const HapticSettings& settings) noexcept;

/// One device in one tick, solved by the model that the settings select. The models handle the triangles of
/// meshes and no other shape.
class ComparisonSolver {
  public:
    /// Moves the proxy with the objects' own motion before the solve (moving_obstacles.h).
    static void followObjects(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                              DeviceState& state, uint32_t& flags) noexcept;

    ComparisonSolver(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                     DeviceState& state, SolveResult& rest) noexcept;

    /// Places the proxy in the first tick; false while the HIP is inside a body.
    [[nodiscard]] bool begin() noexcept;
    /// Resumes the solve without friction from `place`, where it ended in the last tick.
    void resumeFrom(const glm::dvec3& place) noexcept;
    void moveTowards(const glm::dvec3& goal) noexcept;
    void dropTowards(const glm::dvec3& goal) noexcept;
    /// Starts the path to a place at `place`, where the proxy stood before, in the models whose proxy can be
    /// placed anywhere.
    void startAt(const glm::dvec3& place) noexcept;
    void placeAt(const glm::dvec3& place) noexcept;
    [[nodiscard]] bool slideOnFacet(const glm::dvec3&) noexcept { return false; }
    [[nodiscard]] bool touchesAt(const glm::dvec3&) noexcept { return true; }
    /// Returns to the end of an earlier solve for `hip`. True where that is on the surface.
    [[nodiscard]] bool returnTo(const glm::dvec3& place, const glm::dvec3& hip) noexcept;
    void settleClearance() noexcept { state_.clearance = 0.0; } // a point has no clearance

  private:
    DeviceState& state_;
    std::variant<NeighbourhoodWatch, RayProxy<double>, RayProxy<float>> solver_;
};

/// Clears a comparison solver's state from the proxy, before ProxySolver takes over.
void leaveComparison(const HapticScene& scene, ObjectMotions motions, DeviceState& state) noexcept;

} // namespace touchstone

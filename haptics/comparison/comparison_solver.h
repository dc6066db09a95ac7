#pragma once
// The comparison solvers: contact models for comparison with the virtual proxy, behind the interface that
// ProxySolver offers to the later stages.

#include "haptics/comparison/neighbourhood_watch.h"
#include "haptics/comparison/ray_proxy.h"
#include "haptics/comparison/virtual_point.h"
#include "haptics/settings/haptic_settings.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace touchstone {

/// True where `settings` select one of them and `scene` has its data and only objects that it handles: else
/// ProxySolver solves the tick.
[[nodiscard]] bool comparisonIsReady(const HapticScene& scene, const HapticSettings& settings) noexcept;

/// Why the sweep touches `scene` although `settings` select a comparison solver: it does not handle some
/// object. Empty where it does, or the sweep is selected. Not for the servo thread.
[[nodiscard]] std::string refusalOf(const HapticScene& scene, const HapticSettings& settings);

/// settingWarnings, and refusalOf where there is one.
[[nodiscard]] std::vector<std::string> settingWarnings(const HapticScene& scene,
                                                       const HapticSettings& settings);

/// One device in one tick, solved by the model that the settings select. Neighbourhood watch and rays handle
/// the triangles of meshes and no other shape, the virtual point shapes that are potential fields.
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
    /// Of the virtual point alone.
    [[nodiscard]] bool slideOnFacet(const glm::dvec3& place) noexcept;
    [[nodiscard]] bool touchesAt(const glm::dvec3&) noexcept { return true; }
    /// Returns to the end of an earlier solve for `hip`. True where that is on the surface.
    [[nodiscard]] bool returnTo(const glm::dvec3& place, const glm::dvec3& hip) noexcept;
    void settleClearance() noexcept { state_.clearance = 0.0; } // a point has no clearance
    /// The model as published may define a force of its own instead of `force`, that of stage 7: [002 eq. 3],
    /// F = (p_c - p_t) k - V b with the whole velocity V (m/s, relative to the surface) and the viscous part
    /// of friction, no larger than forceThreshold. `hip`: reference object frame, in which the force is, too.
    /// `stiffness` N/m, `damping` N.s/m, of a surface that is touched.
    [[nodiscard]] glm::dvec3 asPublished(const glm::dvec3& force, const glm::dvec3& hip,
                                         double workspacePerReference, double stiffness, double damping,
                                         const glm::dvec3& velocity,
                                         const glm::dvec3& viscousForce) const noexcept;
    /// Potential fields interpolate their normals: they have no shading besides.
    [[nodiscard]] static bool shades(const HapticSettings& settings) noexcept {
        return settings.contact != ContactMethod::VirtualPoint &&
               settings.contact != ContactMethod::Potential;
    }

  private:
    using Solver = std::variant<NeighbourhoodWatch, RayProxy<double>, RayProxy<float>, VirtualPoint>;
    static Solver solverFor(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                            DeviceState& state, SolveResult& rest) noexcept;

    DeviceState& state_;
    double forceThreshold_; ///< N; 0: none
    Solver solver_;
};

/// Clears a comparison solver's state from the proxy, before ProxySolver takes over.
void leaveComparison(const HapticScene& scene, ObjectMotions motions, DeviceState& state) noexcept;

} // namespace touchstone

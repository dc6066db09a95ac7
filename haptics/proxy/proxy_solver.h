#pragma once
// The virtual proxy: stages 2 and 3. A sphere moves towards a goal and never through a surface (Ruspini,
// Kolarov and Khatib [000, 001]). It handles only planes, distances and times of impact; haptics/shape and
// haptics/contact supply them.

#include "engine/math/object_motion.h"
#include "haptics/proxy/rising_slide.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/settings/haptic_settings.h"
#include "haptics/solve/solve_result.h"
#include "haptics/state/device_state.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

namespace touchstone {

/// A move shorter than this ends the solve, object units.
inline constexpr double kRestLength = 1e-11;

/// The same after `moves` in this tick: from the eighth on it doubles with every second one, up to 1e-8 (1 nm
/// on a fitted model, 1 µN at 1000 N/m). In a pocket between facets 1e-7 rad apart a move of 1e-9 changes
/// heights by less than the contact gap, and the proxy would circle in it until the budget ends. (At 8e-8 a
/// creeping proxy was taken to rest 1.7e-6 of its object from its goal.)
[[nodiscard]] inline double restLength(uint32_t moves) noexcept {
    return moves < 10 ? kRestLength
                      : std::ldexp(kRestLength, (std::min(static_cast<int>(moves), 28) - 8) / 2);
}

/// False where nothing is touched, and where the budget ended the last move in the air: the contacts are then
/// those of the surface that the proxy was sliding on, farther away than contact.
[[nodiscard]] inline bool touches(const SolveResult& rest) noexcept {
    for (uint32_t i = 0; i < rest.contactCount; ++i)
        if (rest.contacts[i].gap <= kContactReach)
            return true;
    return false;
}

/// One device in one tick. Everything is in the frame of the reference object; radius and lengths in object
/// units.
class ProxySolver {
  public:
    /// `settings.proxyRadius`: workspace metres. The proxy is at least half the weld tolerance of the
    /// reference object: a god-object that closes every narrower crack and stands on a definite side of a
    /// sheet.
    ProxySolver(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                DeviceState& state, SolveResult& rest) noexcept;

    /// Moves the proxy with the objects' own motion before the solve (moving_obstacles.h).
    static void followObjects(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                              DeviceState& state, uint32_t& flags) noexcept;

    /// Places the proxy in the first tick, in free space only. False while touch may not begin
    /// (place_proxy.h) or the HIP is within the proxy's radius of a surface; nothing is felt until then. True
    /// from then on.
    [[nodiscard]] bool begin() noexcept;

    /// Resumes the solve without friction from `place`, where it ended in the last tick.
    void resumeFrom(const glm::dvec3& place) noexcept { placeAt(place); }

    /// Moves the proxy to the point nearest to `goal` (reference object frame) that it can reach by sliding
    /// in free space. Anytime: every move ends in free space and none leads away from the goal.
    void moveTowards(const glm::dvec3& goal) noexcept;

    /// Moves the proxy straight towards `goal` until contact, without sliding. May exceed the budget by
    /// kDropMoves: where the budget ended a slide in the air, the drop returns the proxy to the surface.
    void dropTowards(const glm::dvec3& goal) noexcept;

    /// True where a proxy at `p` (reference object frame) would touch a surface and be nearer than its radius
    /// to none. Moves nothing. Only after a solve.
    [[nodiscard]] bool touchesAt(const glm::dvec3& p) noexcept;

    /// Moves straight to the place nearest to `goal` on the plane of the one facet that the proxy rests on,
    /// where the path is free and that facet also holds the proxy there. False, and nothing moved, otherwise.
    /// Only after a solve that came to rest. Equals two moves of moveTowards.
    [[nodiscard]] bool slideOnFacet(const glm::dvec3& goal) noexcept;

    /// Puts the proxy at `p` (reference object frame) without a sweep. Only for places known to be free: a
    /// former place of the proxy, or one that isFree confirms.
    void placeAt(const glm::dvec3& p) noexcept;

    /// Starts the path to a place that a solve looks for at `p`, a former place of the proxy.
    void startAt(const glm::dvec3& p) noexcept { placeAt(p); }

    /// Returns to the end of an earlier solve. True where that is on the surface.
    [[nodiscard]] bool returnTo(const glm::dvec3& p, const glm::dvec3& hip) noexcept;

    /// True when the proxy at its present place is farther than its radius from every surface.
    [[nodiscard]] bool isFree() noexcept;

    /// Stage 4 applies.
    [[nodiscard]] static constexpr bool shades(const HapticSettings&) noexcept { return true; }

    /// At the end of the tick: stores the proxy's clearance from one-sided surfaces. No effect in scenes
    /// without them.
    void settleClearance() noexcept {
        if (scene_.plan.oneSided)
            measureClearance();
    }

    [[nodiscard]] double radius() const noexcept { return radius_; }

  private:
    /// A sweep ends at this gap, below the resting gap: a surface that the proxy rests on at kContactGap and
    /// slides along is then not hit again at once by the rounding of its gradient.
    static constexpr double kStrikeGap = 0.5 * kContactGap;

    void adoptReference(int reference) noexcept;
    void measureClearance() noexcept;
    bool advance(const glm::dvec3& goal) noexcept;
    [[nodiscard]] bool findAllContacts(double within) noexcept;
    bool rollAround(const glm::dvec3& goal) noexcept;
    bool goStraight(const glm::dvec3& to) noexcept;
    [[nodiscard]] bool goOver(const glm::dvec3& place, const glm::dvec3& normal) noexcept;
    [[nodiscard]] bool leapToRest(const glm::dvec3& goal) noexcept;
    [[nodiscard]] bool circles(const glm::dvec3& goal, double length) noexcept;
    void slideUp(const glm::dvec3& goal, const glm::dvec3& move, double share, double covered) noexcept;
    void headWithReference(const ObjectMotion& reference) noexcept;
    double cover(const glm::dvec3& direction, double length) noexcept;
    [[nodiscard]] glm::dvec3 ballAhead(const glm::dvec3& direction, double wanted, double margin) noexcept;
    bool gather(CandidateCache& cache, const glm::dvec3& centre, double radius) noexcept;
    void findSubGoal(const glm::dvec3& goal) noexcept;
    void findSubGoal(const glm::dvec3& goal, bool all) noexcept;
    void findSubGoalAmongMany(const glm::dvec3& goal) noexcept;
    void findSubGoalBelow(const glm::dvec3& goal) noexcept;
    bool stop(bool overEdge) noexcept;

    const HapticScene& scene_;
    ObjectMotions motions_;
    double workspaceRadius_;
    double radius_ = 0.0;
    int withoutProgress_ = 0;
    int gathers_ = 0;             ///< of this tick, and attempts at them
    int exchanges_ = 0;           ///< of this tick, where more contacts are near than fit
    int leaps_ = 0;               ///< that this solve may still try
    double slid_ = 0.0;           ///< the last move of this solve, where it was a slide that no surface ended
    double lastMove_ = 0.0;       ///< object units, of this tick
    double lastSlide_ = INFINITY; ///< towards its goal, of this tick; only where shapes are near
    double asked_ = 0.0;          ///< length of the last move that was tried in this tick
    double travel_ = 0.0;         ///< of the HIP in this tick, in the reference object's frame
    glm::dvec3 heading_{0.0};     ///< its direction; zero: none
    int budget_;
    SlideMemory slide_;
    DeviceState& state_;
    SolveResult& rest_;
};

/// Makes `reference` the reference object; transforms the proxy, stiction point and shading state into its
/// frame.
void changeReference(DeviceState& state, ObjectMotions motions, int reference) noexcept;

} // namespace touchstone

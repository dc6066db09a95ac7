#pragma once
// The state that one device's touch carries from tick to tick. Owned by the servo (or by an offline run);
// reset at a scene swap.

#include "engine/math/similarity.h"
#include "haptics/contact/candidates.h"
#include "haptics/safety/force_limiter.h"
#include "haptics/solve/solve_result.h"
#include "haptics/state/dents.h"
#include "haptics/state/grasp.h"
#include "haptics/state/moving_obstacle.h"

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace touchstone {

/// State of the neighbourhood watch, with `contact=neighbourhood`.
struct WatchState {
    uint32_t side = 0;     ///< TriangleSide of the reference object
    bool touching = false; ///< else the proxy is where the HIP is
};

/// Hands of one servo, at most.
inline constexpr size_t kMaxHands = 4;

/// What a servo publishes for the eye.
using HandDents = std::array<Dents, kMaxHands>;

enum class FrictionState : uint8_t { Free, Sticking, Sliding };

/// What haptic programs see of the hand's motion besides its velocity. Followed only in scenes with programs.
struct ToolMotion {
    bool known = false;           ///< `velocity` is that of the last tick
    glm::dvec3 velocity{0.0};     ///< DeviceState::velocity of the last tick, m/s, workspace
    glm::dvec3 acceleration{0.0}; ///< m/s^2, workspace, through the low-pass of the velocity
    glm::dvec3 direction{0.0};    ///< unit, of the last motion along a surface; 0 before any; workspace
    double time = 0.0;            ///< s since touch began
};

/// Construct before the servo starts (it allocates); the step only writes into it.
struct DeviceState {
    // Stage 1
    bool sampled = false;     ///< a valid sample has been seen since the reset
    glm::dvec3 hip{0.0};      ///< workspace, last tick
    glm::dvec3 travel{0.0};   ///< m, of the HIP since the last tick, workspace
    glm::dvec3 velocity{0.0}; ///< m/s, workspace, filtered
    double unsampled = 0.0;   ///< s since the last usable sample, kForceRampOutTime at most

    // Stages 2 and 3. The proxy is stored in the frame of the reference object and moves with it: where
    // objects move the object touched last, in a scene at rest the one nearest to where touch began.
    bool placed = false; ///< the proxy is in free space or on a surface; false: not yet outside
    /// The model appeared where the hand was (a scene swap, a device that is taken up or returns): nothing is
    /// felt before the hand is clear of it (proxy/clear_of_model.h).
    bool mustLeave = false;
    int reference = -1;    ///< HapticScene::objects
    glm::dvec3 proxy{0.0}; ///< reference object frame, object units
    /// Workspace m by which the proxy is clear of one-sided surfaces, while placed: the radius, or less while
    /// a proxy that has grown is still being lifted out. The proxy is coming through any nearer surface.
    double clearance = 0.0;
    CandidateCache candidates;
    CandidateCache
        obstacleCandidates; ///< of one object that moves towards the proxy, or of a place far from it
    std::vector<MovingObstacle> carried = std::vector<MovingObstacle>(256); ///< the near ones, during a tick
    JammedObjects jammed;
    double gatherMargin = 1e-3; ///< object units; adapts to the density of triangles
    WatchState watch;

    SolveResult rest; ///< of this tick; kept here because clearing it each tick costs more than a sweep

    // Stage 4: the goal of the shaded planes, relative to the HIP, to start the next tick from.
    bool shaded = false;
    glm::dvec3 shadedNormal{0.0}; ///< reference object frame
    glm::dvec3 shadedTurn{0.0};   ///< turn of that normal in the last tick
    int shadedObject = -1;        ///< whose facet alone held the HIP off; -1: none or several
    uint32_t shadedTriangle = 0;

    // Stage 6, reference object frame.
    FrictionState friction = FrictionState::Free;
    glm::dvec3 stictionPoint{0.0}; ///< a proxy position; with friction=ho on the chord between two
    glm::dvec3 frictionless{0.0};  ///< where the proxy would be without friction; while friction is not Free

    // Haptic programs
    ToolMotion tool;

    // Local deformation: the dents that this hand makes. They outlive its touch.
    Dents dents;

    Grasp grasp;

    // Stage 8
    ForceLimiterState limiter;

    /// Forgets the touch; keeps what the device still holds (the limiter's last command).
    void forgetTouch() noexcept {
        sampled = placed = mustLeave = shaded = watch.touching = false;
        shadedTurn = glm::dvec3(0.0);
        velocity = glm::dvec3(0.0);
        reference = -1;
        friction = FrictionState::Free;
        tool = {};
        candidates.invalidate();
        jammed.count = 0;
        candidates.ignore({});
    }
};

} // namespace touchstone

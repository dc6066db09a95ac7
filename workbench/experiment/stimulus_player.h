#pragma once
// What a page of an experiment lets be felt, on a haptic thread of its own.

#include "experiment/people/session_flow.h"
#include "haptics/finger/arc_finger.h"
#include "haptics/servo/force_switch.h"
#include "workbench/experiment/experiment_hand.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <optional>

namespace touchstone {

/// Main thread. The force comes from its servo's safety stage alone.
class StimulusPlayer {
  public:
    virtual ~StimulusPlayer() = default;

    /// From the next tick on, with nothing felt before the hand has left the new surface. Throws Error.
    virtual void show(const experiment::SessionFlow::Shown& shown) = 0;
    virtual void rest() = 0; ///< nothing is felt
    [[nodiscard]] virtual ForceSwitch& forceSwitch() = 0;
    /// Once a frame. `pointer`: 0..1 across the window, from its upper left corner; none: the mouse has left
    /// it.
    virtual void moveMouse(const std::optional<glm::dvec2>& pointer, bool pressed) = 0;

    struct Reading {
        uint64_t ticks = 0, missed = 0;
        bool touching = false;
        double command = 0.0;               ///< N, magnitude
        std::optional<FingerPose> finger{}; ///< in the plane; none for models
    };
    [[nodiscard]] virtual Reading read() = 0; ///< once a frame
};

/// The player of a condition's curves or models. `hand` and `plan` outlive it. Throws Error, also for a model
/// that cannot be opened: both are open before the first is felt.
[[nodiscard]] std::unique_ptr<StimulusPlayer> playerOf(const experiment::StudyPlan& plan, size_t condition,
                                                       ExperimentHand& hand, double rateHz);

} // namespace touchstone

#pragma once
// Buttons, switches, sliders and knobs that set settings of the session [000 Fig. 11].

#include "haptics/body/body_solver.h"
#include "haptics/body/body_world.h"
#include "haptics/settings/haptic_settings.h"

#include <span>
#include <string>
#include <vector>

namespace touchstone::body {

/// Empty where a joint's setting is one that `--set` would take, with each of its values; else what is wrong.
[[nodiscard]] std::string settingProblem(const JointSetting& setting);

/// The controls of a scene. Not for the servo's thread; it may differ from the one that moves the bodies.
class JointSettings {
  public:
    JointSettings() = default;
    explicit JointSettings(const BodyWorld& world);

    [[nodiscard]] bool empty() const { return controls_.empty(); }
    /// Changes `settings` where a control was moved since the last call; the first call only sees where they
    /// are. A control keeps its value until it is 0.6 of the way to the next one, so that none chatters.
    /// True where something changed.
    bool apply(std::span<const Pose> workspaceFromBody, HapticSettings& settings);

  private:
    struct Control {
        BodyJoint joint;            // frames, axes and setting alone
        std::vector<double> places; // of the values on the free axis, m or rad, ascending
        int at = -1;                // index of `places`; -1: not seen yet
        size_t value = 0;
        double rest = 0.0;
    };
    [[nodiscard]] static std::string valueOf(const Control& control);

    std::vector<Control> controls_;
    std::vector<BodyState> states_;
};

} // namespace touchstone::body

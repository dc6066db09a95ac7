#pragma once
// The mouse as a device: it cannot push, so what the force would do to a hand is seen instead.

#include "devices/device/device.h"
#include "engine/exchange/triple_buffer.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

namespace touchstone {

/// How goals that come with the frames of a window become motion of a hand.
struct MouseSmoothing {
    /// rad/s. The hand follows its goal like a critically damped spring of this frequency: 2 / frequency
    /// behind a steady drag, and the steps of 30 Hz events come out 23 times smaller. Higher follows closer
    /// and lets the rhythm of the frames be felt as a rattle.
    double frequency = 40.0;
    /// m/s. A goal further away than the hand can follow at this speed is approached at this speed. A hand
    /// that explores moves below 0.5 m/s.
    double maxSpeed = 0.5;
    /// N/m with which the hand is held to its goal, > 0. Force makes it stay behind by force / stiffness: a
    /// friction of 0.3 N is seen as 2 mm of lag, and bumps make the hand run ahead and hang back (pseudo-
    /// haptics). Its mass, stiffness / frequency² = 94 g, is a hand's with a Phantom in it, so the loop is as
    /// stable as theirs: damping 2 * stiffness / frequency = 7.5 N·s/m, enough for walls of 15 kN/m at 1 kHz.
    double stiffness = 150.0;
};

/// Where the hand of a mouse is to be.
struct MouseGoal {
    glm::dvec3 position{0.0}; ///< m, in the frame of `object`
    /// The object of the haptic scene with which the goal goes along; -1: it stands in the workspace.
    int object = -1;
    /// N: the force with which the hand may press at most; 0: it hovers.
    double press = INFINITY;
    double stiffness = 600.0; ///< N/m of what is pressed on
    /// Of all that the hand may meet on its way: the greatest stiffness, N/m (less than `stiffness`: that),
    /// and the greatest coefficient of friction.
    double stiffest = 0.0, friction = 4.0 / 3.0;
    /// By how much what friction holds may grow in a tick in which the hand stays: 1 but for friction=ho,
    /// which takes hold with the static coefficient where it slid with the dynamic one.
    double grip = 1.0;
    uint32_t buttons = 0;
};

/// Turns goals given at the rate of a window into smooth motion at the rate of the servo: position and
/// velocity are continuous, |velocity| <= maxSpeed relative to the object that the goal goes along with, and
/// a stalled servo resumes where it was instead of jumping.
///
/// The hand yields to the felt force (TouchFeedback), not to the command: otherwise it would sink in by
/// press / smoothing.stiffness, 4 mm for 0.6 N, whenever the safety stage fades the force, and be pushed out
/// again. It presses with MouseGoal::press at most: the force of the last tick and the way into the surface
/// in this one, times the stiffness, never come to more. So however long no goal comes, and however the
/// objects move meanwhile, the force stays what was asked for. A hand that does not press, and touches
/// nothing that it pressed on before, is given none (DeviceMapping::coupling): what it strikes on its way is
/// known a tick later. Samples have no age: a picture that stalls does not make the place of the hand less
/// certain.
class MouseDevice final : public Device {
  public:
    /// N (stage 7) with which a hand that hovers may resist what runs into it, until it is pushed aside.
    static constexpr double kHoverForce = 0.05;

    explicit MouseDevice(const MouseSmoothing& smoothing = {});

    /// Main thread. A goal that is not finite is ignored.
    void moveTo(const MouseGoal& goal) noexcept;
    /// Free in the workspace, pressing as hard as its spring does.
    void moveTo(const glm::dvec3& position) noexcept { moveTo(MouseGoal{.position = position}); }
    /// Main thread: the hand is lifted off (samples are not valid). It begins again at the next goal.
    void release() noexcept;

    [[nodiscard]] std::string name() const override { return "mouse"; }
    [[nodiscard]] DeviceLimits limits() const override { return {}; }
    void feel(const TouchFeedback& felt) noexcept override;
    /// Servo thread. `time` must not run backwards (then the hand stands still).
    [[nodiscard]] DeviceSample sample(double time) noexcept override;
    void apply(const DeviceCommand&) noexcept override {}

    /// Longest time the hand moves on in one sample, s: what a stall may cost in distance is maxSpeed times
    /// this.
    static constexpr double kLongestStep = 0.010;

  private:
    struct Told {
        MouseGoal goal;
        bool held = false;
        uint32_t releases = 0; // before it
    };

    [[nodiscard]] const ObjectMotion* motionOf(int object) const noexcept;
    void easePress(double dt) noexcept;
    void rideAlong() noexcept;
    void follow(const glm::dvec3& goal, double dt) noexcept;
    void boundPress(const glm::dvec3& from) noexcept;

    MouseSmoothing smoothing_;
    TripleBuffer<Told> told_;
    uint32_t releases_ = 0; // main thread
    // Servo thread:
    TouchFeedback felt_;
    std::array<glm::dvec3, 3> planes_{};
    glm::dvec3 position_{0.0}, velocity_{0.0};
    double lastTime_ = 0.0;
    double press_ = INFINITY; // N, that holds in this tick
    uint32_t begunAfter_ = 0; // of Told::releases
    bool moving_ = false;
    bool presses_ = false; // or leaves what it pressed on
};

} // namespace touchstone

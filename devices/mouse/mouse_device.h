#pragma once
// The mouse as a haptic device without force output: the effect of the force on the hand is displayed
// instead.

#include "devices/device/device.h"
#include "engine/exchange/triple_buffer.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

namespace touchstone {

/// How goals at the frame rate become motion of the hand.
struct MouseSmoothing {
    /// rad/s. The hand follows its goal like a critically damped spring of this frequency: it lags a steady
    /// drag by 2 / frequency, and attenuates the steps of 30 Hz events 23 times. A higher value follows more
    /// closely and renders the frame rhythm as a rattle.
    double frequency = 40.0;
    /// m/s. Bound on the hand's speed towards a distant goal. A hand that explores moves below 0.5 m/s.
    double maxSpeed = 0.5;
    /// N/m between hand and goal, > 0. Force makes the hand lag by force / stiffness: a friction of 0.3 N is
    /// seen as 2 mm of lag, and bumps make the hand run ahead and hang back (pseudo-haptics). Its mass,
    /// stiffness / frequency² = 94 g, is that of a hand with a Phantom, so the loop is as stable as theirs:
    /// damping 2 * stiffness / frequency = 7.5 N·s/m, enough for walls of 15 kN/m at 1 kHz.
    double stiffness = 150.0;
};

/// Target of the mouse's hand.
struct MouseGoal {
    glm::dvec3 position{0.0}; ///< m, in the frame of `object`
    /// The object of the haptic scene with which the goal moves; -1: fixed in the workspace.
    int object = -1;
    /// N: maximum force of the hand; 0: it hovers.
    double press = INFINITY;
    double stiffness = 600.0; ///< N/m of the pressed surface
    /// Maxima over everything the hand may meet on its way: stiffness, N/m (if less than `stiffness`: that),
    /// and coefficient of friction.
    double stiffest = 0.0, friction = 4.0 / 3.0;
    /// Factor by which the friction force may grow in a tick in which the hand stays: 1 except for
    /// friction=ho, which sticks with the static coefficient where it slid with the dynamic one.
    double grip = 1.0;
    uint32_t buttons = 0;
};

/// Turns goals at the frame rate into smooth motion at the servo rate: position and velocity are continuous,
/// |velocity| <= maxSpeed relative to the object that the goal moves with, and a stalled servo resumes in
/// place without a jump.
///
/// The hand yields to the felt force (TouchFeedback), not to the command. Otherwise it would sink in by press
/// / smoothing.stiffness, 4 mm for 0.6 N, whenever the safety stage fades the force, and be pushed out again.
/// It presses with at most MouseGoal::press, however long no goal arrives, however the objects move meanwhile
/// and whatever it slides onto: it sinks no deeper than the last tick's force and stiffness allow, and where
/// a tick finds it deeper than that, on a stiffer surface, it gives way in that tick (DeviceLimits::press). A
/// hand that neither presses nor touches what it pressed before receives no force (DeviceMapping::coupling):
/// what it hits on its way is known one tick later. Samples have no age: a stalled frame does not make the
/// position of the hand less certain.
class MouseDevice final : public Device {
  public:
    /// N (stage 7) with which a hovering hand may resist a moving object, until it is pushed aside.
    static constexpr double kHoverForce = 0.05;

    explicit MouseDevice(const MouseSmoothing& smoothing = {});

    /// Main thread. A non-finite goal is ignored.
    void moveTo(const MouseGoal& goal) noexcept;
    /// A goal fixed in the workspace; the press is limited by the spring alone.
    void moveTo(const glm::dvec3& position) noexcept { moveTo(MouseGoal{.position = position}); }
    /// Main thread: lifts the hand off (samples become invalid). The next goal starts it again.
    void release() noexcept;

    [[nodiscard]] std::string name() const override { return "mouse"; }
    /// Of a hand that presses, the press. Servo thread, after `sample`.
    [[nodiscard]] DeviceLimits limits() const override;
    void feel(const TouchFeedback& felt) noexcept override;
    /// Servo thread. `time` must not run backwards (then the hand stands still).
    [[nodiscard]] DeviceSample sample(double time) noexcept override;
    void apply(const DeviceCommand&) noexcept override {}

    /// s; longest advance of the hand in one sample. A stall moves it by at most maxSpeed times this.
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
    double press_ = INFINITY; // N, of this tick
    uint32_t begunAfter_ = 0; // of Told::releases
    bool moving_ = false;
    bool presses_ = false; // or is leaving what it pressed
};

} // namespace touchstone

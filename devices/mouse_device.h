#pragma once
// The mouse as a device: it cannot push, so what the force would do to a hand is seen instead.

#include "devices/device.h"
#include "engine/exchange/triple_buffer.h"

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

/// Turns goals given at the rate of a window into smooth motion at the rate of the servo: position and
/// velocity are continuous, |velocity| <= maxSpeed, and a stalled servo resumes where it was instead of
/// jumping. The hand yields to the force of the command.
class MouseDevice final : public Device {
  public:
    explicit MouseDevice(const MouseSmoothing& smoothing = {});

    /// Main thread, once every frame even when the mouse rests: what the servo sees ages from here, so that a
    /// frozen window counts as stale input. `goal` in the device frame, m; a goal that is not finite is
    /// ignored.
    void moveTo(const glm::dvec3& goal, uint32_t buttons = 0) noexcept;
    /// Main thread: the hand is gone (samples become invalid) until the next moveTo, which it starts from.
    void release() noexcept;

    [[nodiscard]] std::string name() const override { return "mouse"; }
    /// Goals come with the frames of a window, which may stutter: they go stale later than a device's
    /// samples.
    [[nodiscard]] DeviceLimits limits() const override {
        DeviceLimits limits;
        limits.staleAge = 0.25;
        return limits;
    }
    /// Servo thread. `time` must not run backwards (then the hand stands still).
    [[nodiscard]] DeviceSample sample(double time) noexcept override;
    /// Servo thread: what the hand yields to from the next sample on.
    void apply(const DeviceCommand& command) noexcept override { force_ = command.force(); }

    /// Longest time the hand moves on in one sample, s: what a stall may cost in distance is maxSpeed times
    /// this.
    static constexpr double kLongestStep = 0.010;

  private:
    struct Goal {
        glm::dvec3 position{0.0};
        uint32_t buttons = 0;
        bool held = false;
    };

    void follow(const glm::dvec3& goal, double dt) noexcept;

    MouseSmoothing smoothing_;
    TripleBuffer<Goal> goal_;
    // Servo thread:
    glm::dvec3 position_{0.0}, velocity_{0.0}, force_{0.0};
    double lastTime_ = 0.0, goalTime_ = 0.0;
    bool moving_ = false;
};

} // namespace touchstone

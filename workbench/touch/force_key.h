#pragma once

#include "haptics/servo/force_switch.h"

#include <cstdint>
#include <optional>

namespace touchstone {

/// Interprets the force key. A press switches the force off at once, on the thread that sees it first.
/// Whether it switches the force on is decided here, once per frame: only a single press while the force is
/// off, without any other since the previous frame. Of several presses in a long frame, one was meant to
/// switch the force off by a user who cannot see the effect of the others. While a text field has the focus
/// or a recording is shown, a press only switches the force off.
class ForceKey {
  public:
    explicit ForceKey(ForceSwitch& force) : force_(force) {}

    /// Any thread. `plain`: without Ctrl, Alt and Super; with them it only switches off.
    void press(bool plain) noexcept { force_.takeAway(plain); }

    /// Main thread: a press from the window's own events. `watched`: presses seen by the watch thread;
    /// nullopt without one. A press that the watch does not see within kPatience frames switches the force
    /// off all the same: an input method may deliver keys to the window alone.
    void pressInWindow(bool plain, std::optional<uint32_t> watched);

    /// Main thread, at the start of a frame. Returns whether the force is on; `on`: its state in the previous
    /// frame.
    [[nodiscard]] bool settle(bool on, bool mayGiveBack, std::optional<uint32_t> watched);
    /// Main thread: the watch was late or failed a moment ago, and until that is over a press only switches
    /// the force off.
    [[nodiscard]] bool late() const noexcept { return late_ > 0; }
    /// Main thread: the panels switched the force on or off.
    void set(bool on);

  private:
    static constexpr int kPatience = 4, kForget = 30; // frames
    void compare(std::optional<uint32_t> watched);

    ForceSwitch& force_;
    ForceSwitch::State settled_;
    uint32_t inWindow_ = 0; // presses
    int behind_ = 0;        // number of frames in which the watch saw fewer presses than the window;
                            // negative: more
    /// Frames in which the force stays off: the watch was late or failed, and its delayed report of a press
    /// already seen by the window would count as another one.
    int late_ = 0;
    bool watching_ = false; // in the previous frame
};

} // namespace touchstone

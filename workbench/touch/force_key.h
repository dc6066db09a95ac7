#pragma once

#include "haptics/servo/force_switch.h"

#include <cstdint>
#include <optional>

namespace touchstone {

/// What the force key means. A press takes the force away at once, on the thread that sees it first; whether
/// it gives the force back is decided here, once a frame: one press where the force was off, and nothing else
/// that came since the frame before. Of several presses in a frame that takes long one meant to take the
/// force away, by somebody who cannot see what the others came to. While a text is typed or a recording is
/// looked at a press only takes away.
class ForceKey {
  public:
    explicit ForceKey(ForceSwitch& force) : force_(force) {}

    /// Any thread. `plain`: without Ctrl, Alt and Super; with them it only takes away.
    void press(bool plain) noexcept { force_.takeAway(plain); }

    /// Main thread: a press came through the window's own events. `watched`: presses that another thread has
    /// seen, nothing where there is none. What that does not see within kPatience frames takes the force away
    /// all the same: an input method may hand keys to the window alone.
    void pressInWindow(bool plain, std::optional<uint32_t> watched);

    /// Main thread, at the begin of a frame. Returns whether the force is on; `on`: whether it was in the
    /// frame before.
    [[nodiscard]] bool settle(bool on, bool mayGiveBack, std::optional<uint32_t> watched);
    /// Main thread: the panels have switched the force on or off.
    void set(bool on);

  private:
    static constexpr int kPatience = 4, kForget = 30; // frames
    void compare(std::optional<uint32_t> watched);

    ForceSwitch& force_;
    ForceSwitch::State settled_;
    uint32_t inWindow_ = 0; // presses
    int behind_ = 0;        // frames in which the watch has seen fewer than the window; below zero: more
    /// Frames in which nothing is given back: the watch was late or is gone, and what it still has to say of
    /// a press that the window has told already would be taken for another one.
    int late_ = 0;
    bool watching_ = false; // in the frame before
};

} // namespace touchstone

#pragma once

#include "sound/sound_card.h"
#include "workbench/sound/sound_choice.h"
#include "workbench/sound/sounding_hand.h"

namespace touchstone {

/// The window's sound: a tap behind the hand, and a sound card while one is wanted. Main thread.
class SoundController {
  public:
    /// `hand` outlives it.
    explicit SoundController(Device& hand) : hand_(hand, feed_) {}

    /// What the servo is to hold; the servo is gone before this is.
    [[nodiscard]] Device& hand() { return hand_; }
    /// Once a frame.
    void update(const SoundChoice& choice) { card_.update(choice.on, choice.level()); }
    /// Another world is about to be touched.
    void interrupt() { card_.interrupt(); }
    [[nodiscard]] SoundStatus status() const;

  private:
    SoundFeed feed_;
    SoundingHand hand_;
    SoundCard card_{feed_};
};

} // namespace touchstone

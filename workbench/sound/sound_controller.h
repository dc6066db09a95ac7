#pragma once

#include "sound/sound_card.h"
#include "workbench/sound/sound_choice.h"
#include "workbench/sound/sounding_hand.h"

namespace touchstone {

/// The window's sound: a tap on the hand, and a sound card while sound is on. Main thread.
class SoundController {
  public:
    /// `hand` outlives it.
    explicit SoundController(Device& hand) : hand_(hand, feed_) {}

    /// The device for the servo; the servo must end before this object.
    [[nodiscard]] Device& hand() { return hand_; }
    /// SoundingHand::hear.
    void hear(const std::atomic<double>& impact) { hand_.hear(impact); }
    /// Every frame.
    void update(const SoundChoice& choice) { card_.update(choice.on, choice.level()); }
    /// Another model is about to be touched.
    void interrupt() { card_.interrupt(); }
    [[nodiscard]] SoundStatus status() const;

  private:
    SoundFeed feed_;
    SoundingHand hand_;
    SoundCard card_{feed_};
};

} // namespace touchstone

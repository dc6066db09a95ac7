#pragma once

#include "sound/loudness.h"

#include <span>

namespace touchstone {

/// What a sound card plays.
class SoundSource {
  public:
    virtual ~SoundSource() = default;
    /// The card's thread: no allocation, lock or wait. |left|, |right| <= the volume.
    virtual void fill(std::span<SoundFrame> frames) noexcept = 0;
    virtual void setVolume(float volume) noexcept = 0; ///< any thread; 0..1
};

} // namespace touchstone

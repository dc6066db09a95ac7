#include "sound/synthesizer.h"

namespace touchstone {

size_t Synthesizer::render(std::span<SoundFrame> frames, double speed) noexcept {
    constexpr float kNear = 0.9238795f, kFar = 0.3826834f; // cos and sin of 22.5 degrees
    for (size_t made = 0; made < frames.size(); ++made) {
        StretchedFrame rates;
        if (!stretcher_.pop(rates, speed))
            return made;
        frames[made] =
            loudness_.add({kNear * rates.press + kFar * rates.drag, kFar * rates.press + kNear * rates.drag});
    }
    return frames.size();
}

void Synthesizer::reset() noexcept {
    change_.reset();
    stretcher_.reset();
    loudness_.reset();
}

} // namespace touchstone

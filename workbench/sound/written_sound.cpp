#include "workbench/sound/written_sound.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace touchstone {

void WrittenSound::add(const SoundTick& tick) {
    if (seconds_ == 0.0)
        early_ = static_cast<size_t>(std::lround((tick.dt + Loudness::kLookAhead) * kRate));
    last_ = tick;
    seconds_ += tick.dt;
    (void)synthesizer_.push(tick); // all previous ticks have been rendered
    render();
}

void WrittenSound::render() {
    for (size_t made = kBlock; made == kBlock;) {
        made = synthesizer_.render(frames_);
        const size_t skip = std::min(made, early_ - skipped_);
        skipped_ += skip;
        written_ += made - skip;
        file_.write(std::span(frames_).subspan(skip, made - skip));
    }
}

/// Renders the tail of the last ticks by repeating the last one, which adds no change.
void WrittenSound::commit() {
    const auto whole = static_cast<size_t>(std::lround(seconds_ * kRate));
    while (seconds_ > 0.0 && written_ < whole) {
        (void)synthesizer_.push(last_);
        render();
    }
    file_.commit();
}

} // namespace touchstone

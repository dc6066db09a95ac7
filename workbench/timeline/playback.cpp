#include "workbench/timeline/playback.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

void Playback::moveTo(size_t index) {
    cursor_ = std::min(index, timeline_->size() - 1);
    position_ = timeline_->seconds(cursor_);
}

void Playback::seek(double seconds) {
    moveTo(timeline_->indexAt(seconds));
}

void Playback::step(long ticks) {
    const long last = static_cast<long>(timeline_->size()) - 1;
    moveTo(static_cast<size_t>(std::clamp(static_cast<long>(cursor_) + ticks, 0L, last)));
}

void Playback::stepSeconds(double seconds) {
    const size_t from = cursor_;
    seek(timeline_->seconds(from) + seconds);
    // Also over a gap, and where ticks are far apart.
    if (seconds > 0.0 && cursor_ <= from)
        moveTo(from + 1);
    if (seconds < 0.0 && cursor_ >= from)
        moveTo(from > 0 ? from - 1 : 0);
}

void Playback::play(bool playing) {
    playing_ = playing;
    if (playing && (cursor_ >= last() || cursor_ < first()))
        moveTo(first());
}

void Playback::markBegin() {
    begin_ = cursor_;
    if (end_ && *end_ <= *begin_)
        end_.reset();
}

void Playback::markEnd() {
    end_ = cursor_;
    if (begin_ && *begin_ >= *end_)
        begin_.reset();
}

void Playback::advance(double seconds) {
    if (!playing_)
        return;
    if (cursor_ < first() || cursor_ > last())
        moveTo(first());
    position_ += std::max(0.0, seconds) * speed_;
    const double begin = timeline_->seconds(first()), end = timeline_->seconds(last());
    if (position_ >= end && !loops()) {
        moveTo(last());
        playing_ = false;
        return;
    }
    if (position_ >= end)
        position_ = begin + std::fmod(position_ - begin, std::max(1e-9, end - begin));
    cursor_ = std::clamp(timeline_->indexAt(position_), first(), last());
    // There are no ticks in a gap.
    if (cursor_ < last() && timeline_->seconds(cursor_ + 1) - position_ > kLongestPause)
        moveTo(cursor_ + 1);
}

} // namespace touchstone

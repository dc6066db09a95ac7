#include "workbench/touch/force_key.h"

#include <algorithm>

namespace touchstone {

void ForceKey::pressInWindow(bool plain, std::optional<uint32_t> watched) {
    if (watched)
        ++inWindow_;
    else
        press(plain);
}

/// Window and watch each see every press, in either order. The differences are modulo 2^32.
void ForceKey::compare(std::optional<uint32_t> watched) {
    const auto more = watched ? static_cast<int32_t>(inWindow_ - *watched) : 0;
    if (more > 0)
        behind_ = std::max(behind_, 0) + 1;
    else if (more < 0)
        behind_ = std::min(behind_, 0) - 1;
    else
        behind_ = 0;
    if (behind_ > kPatience)
        press(false);
    late_ = std::max(late_ - 1, 0);
    if (behind_ > kPatience || (watching_ && !watched))
        late_ = kForget;
    watching_ = watched.has_value();
    if (behind_ > kPatience || behind_ < -kForget) {
        inWindow_ = *watched;
        behind_ = 0;
    }
}

bool ForceKey::settle(bool on, bool mayGiveBack, std::optional<uint32_t> watched) {
    compare(watched);
    for (ForceSwitch::State now = force_.state(); !(now == settled_); now = force_.state()) {
        const uint32_t presses = (now.presses() - settled_.presses()) & 0x7fffffffu;
        const bool onePress = presses == 1 && now.asked() - settled_.asked() == 1;
        const bool wanted = mayGiveBack && late_ == 0 && onePress && !on;
        if (wanted && !force_.giveBack(now))
            continue; // another press arrived meanwhile
        settled_ = wanted ? now.givenBack() : now;
        return wanted;
    }
    return on;
}

void ForceKey::set(bool on) {
    if (on == !force_.off())
        return;
    if (!on)
        force_.takeAway(false);
    else if (force_.giveBack(settled_))
        settled_ = settled_.givenBack();
}

} // namespace touchstone

#include "experiment/people/session_flow.h"

#include <algorithm>

namespace touchstone::experiment {

void SessionFlow::next(Page page, double now) {
    page_ = page;
    since_ = now;
    chosen_ = 0;
    ++cues_;
}

void SessionFlow::press(Key key, double now) {
    if (page_ == Page::Second && key != Key::Enter) {
        chosen_ = key == Key::One ? 1 : 2;
        return;
    }
    if (key != Key::Enter)
        return;
    switch (page_) {
    case Page::Welcome:
        next(session_.finished() ? Page::Finished : session_.training() ? Page::Training : Page::First, now);
        break;
    case Page::Training:
        session_.endTraining();
        next(Page::First, now);
        break;
    case Page::First:
        first_ = now - since_;
        next(Page::Second, now);
        break;
    case Page::Second:
        if (chosen_ == 0)
            break;
        session_.answer(chosen_, first_, now - since_);
        next(session_.finished() ? Page::Finished : session_.training() ? Page::Training : Page::First, now);
        break;
    case Page::Finished:
        break;
    }
}

std::optional<SessionFlow::Shown> SessionFlow::shown() const {
    if (session_.finished() || page_ == Page::Welcome || page_ == Page::Finished)
        return std::nullopt;
    const bool reference = page_ == Page::Training || session_.isReference(page_ == Page::First ? 1 : 2);
    return Shown{session_.condition(), reference, session_.level()};
}

size_t SessionFlow::part() const {
    const auto& order = session_.order();
    return session_.finished()
               ? order.size()
               : static_cast<size_t>(std::ranges::find(order, session_.condition()) - order.begin());
}

} // namespace touchstone::experiment

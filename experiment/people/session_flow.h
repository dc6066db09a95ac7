#pragma once
// What a person sees and feels next, from key to key: the pages of a session [004 §5].

#include "experiment/people/person_session.h"

#include <cstdint>
#include <optional>

namespace touchstone::experiment {

/// Leads through training, first and second interval and answer of each trial, forwards alone. One thread.
class SessionFlow {
  public:
    enum class Page : uint8_t {
        Welcome,  ///< instructions
        Training, ///< the reference, before each condition
        First,    ///< interval
        Second,   ///< interval, with the answer
        Finished
    };
    enum class Key : uint8_t { Enter, One, Two };
    /// What is felt on this page.
    struct Shown {
        size_t condition = 0;
        bool reference = false; ///< else the comparison
        double level = 0.0;     ///< of the comparison
    };

    /// `session` outlives it. A resumed one begins with the instructions, too.
    explicit SessionFlow(PersonSession& session) : session_(session) {}

    /// `now`: s, any steady clock. A key without a meaning on this page does nothing. Throws Error where the
    /// answer cannot be written; the page stays, and Enter tries again.
    void press(Key key, double now);

    [[nodiscard]] Page page() const { return page_; }
    [[nodiscard]] std::optional<Shown> shown() const;
    /// 1 or 2, to be confirmed; 0: none yet.
    [[nodiscard]] int chosen() const { return chosen_; }
    /// Conditions before this one, and all.
    [[nodiscard]] size_t part() const;
    [[nodiscard]] size_t parts() const { return session_.order().size(); }
    /// Grows by one at each transition between stimuli: what the audible cue follows.
    [[nodiscard]] uint32_t cues() const { return cues_; }

  private:
    void next(Page page, double now);

    PersonSession& session_;
    Page page_ = Page::Welcome;
    int chosen_ = 0;
    uint32_t cues_ = 0;
    double since_ = 0.0, first_ = 0.0; // s: when the page came, how long the first interval was there
};

} // namespace touchstone::experiment

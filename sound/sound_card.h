#pragma once

#include "sound/live_sound.h"

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <string>

namespace touchstone {

/// The system's default output, by PortAudio. Enumerating sound cards and opening one takes up to seconds, so
/// a separate thread does it. Without a card, or when it fails while playing, `problem` reports that and
/// nothing else happens. Owner thread for all methods.
class SoundCard {
  public:
    /// The feed outlives it.
    explicit SoundCard(SoundFeed& feed);
    /// Another source than the force: made for the card's rate (frames per second), on another thread.
    explicit SoundCard(std::function<std::unique_ptr<SoundSource>(double rate)> source);
    ~SoundCard();
    SoundCard(const SoundCard&) = delete;
    SoundCard& operator=(const SoundCard&) = delete;

    /// Call regularly (once per frame). `volume`: 0..1, fraction of full scale that is never exceeded.
    void update(bool on, float volume);
    /// SoundPlayer::interrupt.
    void interrupt();

    enum class State : uint8_t { Off, Opening, Playing, Failed };
    [[nodiscard]] State state() const { return state_; }
    [[nodiscard]] const std::string& problem() const { return problem_; } ///< while Failed
    [[nodiscard]] const std::string& name() const { return name_; }       ///< while Playing
    /// While Playing: includes the delay of the card, s.
    [[nodiscard]] SoundPlayer::Figures figures() const;

  private:
    class Stream;

    void close(std::chrono::milliseconds after);
    void listen(bool on);

    SoundFeed* feed_ = nullptr; // null: another source
    std::function<std::unique_ptr<SoundSource>(double)> make_;
    State state_ = State::Off;
    std::string problem_, name_;
    std::shared_ptr<Stream> stream_;
    std::future<std::shared_ptr<Stream>> opening_;
    std::future<void> closing_;
};

} // namespace touchstone

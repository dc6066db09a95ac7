#pragma once
// The window that leads a person through a session (docs/experiment.md): instructions alone, no picture of
// what is felt.

#include "experiment/people/session_flow.h"
#include "renderer/frame_pace.h"
#include "sound/masking_noise.h"
#include "sound/sound_card.h"
#include "workbench/experiment/experiment_hand.h"
#include "workbench/experiment/stimulus_player.h"
#include "workbench/guards/interrupt.h"
#include "workbench/options/experiment_options.h"
#include "workbench/screen/key_queue.h"
#include "workbench/screen/key_watch.h"
#include "workbench/screen/screen.h"
#include "workbench/touch/force_key.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace touchstone {

/// Main thread only.
class ExperimentWindow {
  public:
    /// Opens the window and the device; `session` outlives it. Throws Error.
    ExperimentWindow(const ExperimentOptions& options, experiment::PersonSession& session);
    ~ExperimentWindow();
    ExperimentWindow(const ExperimentWindow&) = delete;
    ExperimentWindow& operator=(const ExperimentWindow&) = delete;

    /// One iteration of the main loop. Throws Error where a model cannot be touched.
    void frame();
    [[nodiscard]] bool closed() const { return interrupted() || window_.shouldClose(); }

  private:
    /// The player of a condition, with the keys that take its force away.
    struct Playing {
        Playing(std::unique_ptr<StimulusPlayer> with, Window& window);
        std::unique_ptr<StimulusPlayer> player;
        ForceKey force;
        InterruptedForce interrupted;
        KeyWatch space, escape;
    };

    void keyDown(int key, int modifiers);
    void takeKeys(double now);
    void follow();
    void moveMouse();
    void draw();
    void writeStatus();
    [[nodiscard]] std::vector<std::string> warnings() const;

    const ExperimentOptions& options_;
    experiment::PersonSession& session_;
    experiment::SessionFlow flow_;
    bool resumed_;
    ExperimentHand hand_;
    Window window_;
    Screen screen_;
    NoiseControl noise_;
    SoundCard card_;
    KeyQueue keys_;
    std::optional<Playing> playing_;
    size_t playingFor_ = 0;           // condition
    std::optional<uint32_t> shownAt_; // flow_.cues() of what is being felt
    bool forceOn_ = true;
    std::vector<experiment::SessionFlow::Key> pressed_;
    std::string problem_;
    StimulusPlayer::Reading reading_;
    FramePace pace_{1.0 / 30.0};
    uint64_t updates_ = 0;
};

} // namespace touchstone

#include "workbench/sound/sound_controller.h"

namespace touchstone {

SoundStatus SoundController::status() const {
    SoundStatus status;
    switch (card_.state()) {
    case SoundCard::State::Off:
        break;
    case SoundCard::State::Opening:
        status.state = "opening";
        break;
    case SoundCard::State::Failed:
        status.state = "failed";
        status.problem = card_.problem();
        break;
    case SoundCard::State::Playing:
        const SoundPlayer::Figures figures = card_.figures();
        status.state = "playing";
        status.card = card_.name();
        status.latency = figures.latency;
        status.peak = figures.peak;
        status.runsDry = figures.runsDry;
        status.leftOut = figures.leftOut;
    }
    return status;
}

} // namespace touchstone

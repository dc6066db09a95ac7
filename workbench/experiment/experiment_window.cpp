#include "workbench/experiment/experiment_window.h"

#include "engine/core/error.h"
#include "engine/core/output_file.h"
#include "engine/core/realtime_guard.h"
#include "engine/time/seconds_now.h"
#include "workbench/experiment/experiment_pages.h"
#include "workbench/options/gpu_options.h"

#include <imgui.h>
#include <nlohmann/json.hpp>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <variant>

namespace touchstone {

namespace {

using experiment::PlanarStimulus;
using experiment::SessionFlow;

constexpr float kVolume = 0.5f; // of full scale; the system's own volume sets the loudness
constexpr std::array<std::string_view, 5> kPageNames{"welcome", "training", "first", "second", "finished"};

bool needsLocation(const experiment::StudyPlan& plan, const std::vector<size_t>& order) {
    return std::ranges::any_of(order, [&](size_t at) {
        const auto moves = [](const experiment::StimulusChoice& choice) {
            const auto* planar = std::get_if<PlanarStimulus>(&choice);
            return planar != nullptr && planar->rendering.location != PlanarLocation::Held;
        };
        return moves(plan.conditions[at].reference) || moves(plan.conditions[at].comparison);
    });
}

} // namespace

ExperimentWindow::Playing::Playing(std::unique_ptr<StimulusPlayer> with, Window& window)
    : player(std::move(with)), force(player->forceSwitch()), interrupted(player->forceSwitch()),
      space(window.handle(), GLFW_KEY_SPACE, [this](bool plain) { force.press(plain); }),
      escape(window.handle(), GLFW_KEY_ESCAPE, [this](bool) { player->forceSwitch().takeAway(false); }) {}

ExperimentWindow::ExperimentWindow(const ExperimentOptions& options, experiment::PersonSession& session)
    : options_(options), session_(session), flow_(session),
      resumed_(!session.trials().empty() || !session.training()), hand_(options.device),
      window_("Touchstone experiment", options.size), screen_(window_, gpuOptions(options.gpu)),
      card_([this](double rate) { return std::make_unique<MaskingNoise>(noise_, rate); }),
      keys_(window_.handle(), [this](int key, int modifiers) { keyDown(key, modifiers); }) {
    if (!session.finished()) {
        playingFor_ = session.condition();
        playing_.emplace(playerOf(session.plan(), playingFor_, hand_, options.rateHz), window_);
    }
}

ExperimentWindow::~ExperimentWindow() {
    if (playing_)
        playing_->player->forceSwitch().takeAway(false);
}

/// Called when the event is handled. A repetition is no press (KeyQueue).
void ExperimentWindow::keyDown(int key, int modifiers) {
    constexpr int kNotPlain = GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER;
    const bool plain = (modifiers & kNotPlain) == 0;
    if (playing_ && key == GLFW_KEY_SPACE)
        playing_->force.pressInWindow(plain, playing_->space.presses());
    if (playing_ && key == GLFW_KEY_ESCAPE)
        playing_->player->forceSwitch().takeAway(false);
    if (!plain)
        return;
    if (key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER)
        pressed_.push_back(SessionFlow::Key::Enter);
    else if (key == GLFW_KEY_1 || key == GLFW_KEY_KP_1)
        pressed_.push_back(SessionFlow::Key::One);
    else if (key == GLFW_KEY_2 || key == GLFW_KEY_KP_2)
        pressed_.push_back(SessionFlow::Key::Two);
}

/// While the force is off nothing was felt that could be answered.
void ExperimentWindow::takeKeys(double now) {
    for (const SessionFlow::Key key : std::exchange(pressed_, {})) {
        if (!forceOn_)
            continue;
        try {
            flow_.press(key, now);
            problem_.clear();
        } catch (const Error& error) {
            problem_ = error.what();
        }
        if (flow_.cues() != noise_.cues())
            noise_.cue();
    }
}

/// Lets the stimulus of the page be felt.
void ExperimentWindow::follow() {
    const std::optional<SessionFlow::Shown> shown = flow_.shown();
    if (shownAt_ == flow_.cues() || !playing_)
        return;
    shownAt_ = flow_.cues();
    if (!shown)
        return playing_->player->rest();
    const auto kind = [&](size_t at) { return session_.plan().conditions[at].reference.index(); };
    const bool models = kind(shown->condition) == 1;
    if (shown->condition != playingFor_ && (models || kind(playingFor_) == 1)) {
        playing_.reset(); // one servo at a time has the hand
        playing_.emplace(playerOf(session_.plan(), shown->condition, hand_, options_.rateHz), window_);
        forceOn_ = true;
    }
    playingFor_ = shown->condition;
    playing_->player->show(*shown);
}

void ExperimentWindow::moveMouse() {
    glm::dvec2 place(0.0);
    glfwGetCursorPos(window_.handle(), &place.x, &place.y);
    place /= glm::max(glm::dvec2(window_.size()), glm::dvec2(1.0));
    const bool inside = place.x >= 0.0 && place.y >= 0.0 && place.x <= 1.0 && place.y <= 1.0;
    const bool pressed = glfwGetMouseButton(window_.handle(), GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS;
    playing_->player->moveMouse(inside ? std::optional(place) : std::nullopt, pressed);
}

std::vector<std::string> ExperimentWindow::warnings() const {
    std::vector<std::string> warnings;
    if (card_.state() == SoundCard::State::Failed)
        warnings.push_back("No white noise: " + card_.problem());
    else if (!options_.noise)
        warnings.emplace_back("No white noise: switched off by --no-noise");
    if (hand_.isMouse())
        warnings.emplace_back(
            "A mouse gives no force: this session tries the procedure, it measures nobody.");
    if (needsLocation(session_.plan(), session_.order()) && hand_.pad().reach <= 0.0)
        warnings.emplace_back(
            "This hand has no contact location display: conditions with a location show none.");
    return warnings;
}

void ExperimentWindow::draw() {
    const glm::vec2 size(window_.size());
    PageInput input{.plan = session_.plan(),
                    .flow = flow_,
                    .condition = playingFor_,
                    .forceOn = forceOn_,
                    .resumed = resumed_,
                    .hand = hand_.name(),
                    .problem = problem_,
                    .window = size,
                    .scale = window_.layoutScale()};
    if (flow_.page() == SessionFlow::Page::Welcome)
        input.warnings = warnings();
    if (flow_.page() == SessionFlow::Page::Training)
        input.finger = reading_.finger;
    drawPage(input);
    // The pointer would show where the hand is held up. ImGui's backend sets the cursor in every frame, so it
    // must hear of it.
    if (playing_ && flow_.shown())
        ImGui::SetMouseCursor(ImGuiMouseCursor_None);
}

void ExperimentWindow::writeStatus() {
    if (options_.statusJson.empty())
        return;
    const nlohmann::ordered_json json{{"update", ++updates_},
                                      {"page", kPageNames[static_cast<size_t>(flow_.page())]},
                                      {"part", flow_.part() + 1},
                                      {"parts", flow_.parts()},
                                      {"chosen", flow_.chosen()},
                                      {"trials", session_.trials().size()},
                                      {"force", forceOn_},
                                      {"command_n", reading_.command},
                                      {"touching", reading_.touching},
                                      {"ticks", reading_.ticks},
                                      {"missed", reading_.missed},
                                      {"noise", card_.state() == SoundCard::State::Playing},
                                      {"problem", problem_},
                                      {"allocations_in_tick", realtime::violations().allocations},
                                      {"validation_messages", screen_.validationMessages()}};
    writeFile(options_.statusJson, json.dump(2) + "\n");
}

void ExperimentWindow::frame() {
    const double now = secondsNow();
    pace_.begin(now);
    // Open from the instructions on, so that a missing card is named there.
    card_.update(options_.noise, flow_.shown() ? kVolume : 0.0f);
    if (playing_) {
        forceOn_ = playing_->force.settle(forceOn_, true, playing_->space.presses());
        forceOn_ = forceOn_ && !playing_->player->forceSwitch().off();
    }
    takeKeys(now);
    follow();
    if (playing_) {
        moveMouse();
        reading_ = playing_->player->read();
    }
    try {
        screen_.restyle(window_.layoutScale());
        keys_.feed();
        if (screen_.target().beginFrame()) {
            draw();
            screen_.target().endFrame(nullptr, {});
        }
    } catch (const DeviceLost& lost) {
        screen_.renew(lost, now);
    }
    writeStatus();
    window_.waitEvents(0.0);
    for (double left = pace_.due() - secondsNow(); left > 0.0; left = pace_.due() - secondsNow())
        window_.waitEvents(left);
}

} // namespace touchstone

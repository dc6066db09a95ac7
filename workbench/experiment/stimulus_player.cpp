#include "workbench/experiment/stimulus_player.h"

#include "engine/time/seconds_now.h"
#include "experiment/stimulus/model_settings.h"
#include "experiment/stimulus/planar_stimulus.h"
#include "haptics/query/surface_pick.h"
#include "haptics/servo/planar_servo.h"
#include "session/device_port.h"
#include "session/session.h"
#include "workbench/model/model.h"

#include <cmath>
#include <map>
#include <variant>

namespace touchstone {

namespace {

using experiment::Condition;
using experiment::SessionFlow;
using experiment::StudyPlan;

/// Curves in the plane under the arc finger.
class PlanarPlayer final : public StimulusPlayer {
  public:
    PlanarPlayer(const StudyPlan& plan, ExperimentHand& hand, double rateHz)
        : plan_(plan), hand_(hand), servo_(portOf(hand.device()), {.rateHz = rateHz}) {
        servo_.start();
    }

    void show(const SessionFlow::Shown& shown) override {
        const Condition& condition = plan_.conditions[shown.condition];
        const auto& stimulus = std::get<experiment::PlanarStimulus>(shown.reference ? condition.reference
                                                                                    : condition.comparison);
        servo_.offer(std::make_shared<const PlanarScene>(experiment::surfaceOf(stimulus, shown.level),
                                                         stimulus.rendering));
    }
    void rest() override { servo_.offer(nullptr); }
    ForceSwitch& forceSwitch() override { return servo_.forceSwitch(); }

    /// The window is 160 mm wide, the curve's top in its middle.
    void moveMouse(const std::optional<glm::dvec2>& pointer, bool) override {
        constexpr double kWidth = 0.16, kHeight = 0.1; // m
        if (MouseDevice* mouse = hand_.mouse(); mouse != nullptr && pointer)
            mouse->moveTo({(pointer->x - 0.5) * kWidth, (0.5 - pointer->y) * kHeight, 0.0});
        else if (mouse != nullptr)
            mouse->release();
    }

    Reading read() override {
        const PlanarTick& tick = servo_.tick();
        Reading reading{.ticks = servo_.ticks(),
                        .missed = servo_.missed(),
                        .touching = tick.felt.touching,
                        .command = glm::length(tick.command.force())};
        if (tick.sampled)
            reading.finger = tick.pose;
        return reading;
    }

  private:
    const StudyPlan& plan_;
    ExperimentHand& hand_;
    PlanarServo servo_;
};

/// Models under the proxy.
class ModelPlayer final : public StimulusPlayer {
  public:
    ModelPlayer(const StudyPlan& plan, size_t condition, ExperimentHand& hand, double rateHz)
        : plan_(plan), hand_(hand), session_({portOf(hand.device())}, {.rateHz = rateHz}) {
        for (const auto* choice :
             {&plan.conditions[condition].reference, &plan.conditions[condition].comparison})
            (void)modelOf(std::get<experiment::ModelStimulus>(*choice));
        session_.start();
    }
    ~ModelPlayer() override {
        session_.stop();
        session_.pump(secondsNow());
    }

    void show(const SessionFlow::Shown& shown) override {
        const Condition& condition = plan_.conditions[shown.condition];
        const auto& stimulus =
            std::get<experiment::ModelStimulus>(shown.reference ? condition.reference : condition.comparison);
        const Model& model = modelOf(stimulus);
        const HapticSettings settings = experiment::settingsOf(condition, shown.reference, shown.level);
        prepareFor(model, settings);
        felt_ = model.haptic;
        bounds_ = workspaceBounds(model);
        (void)session_.touch(model.haptic, model.scene, SceneIdentity{}, settings);
        if (MouseDevice* mouse = hand_.mouse())
            mouse->release();
    }
    void rest() override {
        felt_ = nullptr;
        (void)session_.touch(nullptr, nullptr, SceneIdentity{});
    }
    ForceSwitch& forceSwitch() override { return session_.forceSwitch(); }

    /// As seen from the front; the hand hovers before what is under the pointer, and pressed presses on it.
    void moveMouse(const std::optional<glm::dvec2>& pointer, bool pressed) override {
        constexpr double kPress = 0.6, kHand = 150.0, kStiffness = 600.0, kHover = 0.01; // N, N/m, m
        MouseDevice* const mouse = hand_.mouse();
        if (mouse == nullptr)
            return;
        const double width = 1.2 * bounds_.diagonal();
        const glm::dvec3 middle = bounds_.centre();
        std::optional<SurfacePick> hit;
        if (felt_ != nullptr && pointer)
            hit = pickSurface(*felt_, {},
                              middle +
                                  glm::dvec3((pointer->x - 0.5) * width, (0.5 - pointer->y) * width, width),
                              {0.0, 0.0, -1.0});
        if (!hit)
            return mouse->release();
        const double out = pressed ? -kPress / kHand - kPress / kStiffness : kHover;
        mouse->moveTo(MouseGoal{.position = hit->point + out * hit->normal,
                                .press = pressed ? kPress : 0.0,
                                .stiffness = kStiffness});
    }

    Reading read() override {
        session_.pump(secondsNow());
        const TickRecord& tick = session_.tick();
        const ServoLoop::Counters counters = session_.servo().counters();
        return {.ticks = counters.ticks,
                .missed = counters.missed,
                .touching = tick.output.contacts > 0,
                .command = glm::length(tick.output.command.force())};
    }

  private:
    const Model& modelOf(const experiment::ModelStimulus& stimulus) {
        const auto found = models_.find(stimulus.model);
        if (found != models_.end())
            return found->second;
        return models_.emplace(stimulus.model, loadModelToTouch(stimulus.model, Fit::Workspace))
            .first->second;
    }

    const StudyPlan& plan_;
    ExperimentHand& hand_;
    Session session_;
    std::map<std::filesystem::path, Model> models_;
    std::shared_ptr<const HapticScene> felt_;
    Bounds bounds_{};
};

} // namespace

std::unique_ptr<StimulusPlayer> playerOf(const StudyPlan& plan, size_t condition, ExperimentHand& hand,
                                         double rateHz) {
    if (std::holds_alternative<experiment::ModelStimulus>(plan.conditions[condition].reference))
        return std::make_unique<ModelPlayer>(plan, condition, hand, rateHz);
    return std::make_unique<PlanarPlayer>(plan, hand, rateHz);
}

} // namespace touchstone

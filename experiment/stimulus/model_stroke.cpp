#include "experiment/stimulus/model_stroke.h"

#include "engine/core/error.h"
#include "engine/load/scene_loader.h"
#include "experiment/stimulus/model_settings.h"
#include "haptics/query/surface_pick.h"
#include "haptics/scene/built_for.h"
#include "haptics/tick/stepped_hand.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace touchstone::experiment {

namespace {

constexpr double kWidth = 0.6; // of the reference's extent: its flanks are too steep to be stroked from above
constexpr double kStiffness = 600.0; // N/m, of DeviceLimits
constexpr double kApproach = 0.05;   // s, from the air

/// The reference's highest places along its middle, m; gaps are left out.
std::vector<glm::dvec3> topOf(const ModelStore::Opened& model, const Stroke& stroke) {
    Bounds bounds;
    bounds.include(model.workspaceFromScene.point(model.scene->bounds.low));
    bounds.include(model.workspaceFromScene.point(model.scene->bounds.high));
    const glm::dvec3 extent = bounds.extent(), middle = bounds.centre();
    const double step = stroke.speed / stroke.rateHz, half = 0.5 * kWidth * extent.x;
    std::vector<glm::dvec3> top;
    for (double x = -half; x <= half; x += step)
        if (const auto hit =
                pickSurface(*model.haptic, {}, {middle.x + x, bounds.high.y + extent.y + 0.01, middle.z},
                            {0.0, -1.0, 0.0}))
            top.push_back(hit->point);
    return top;
}

} // namespace

const ModelStore::Opened& ModelStore::open(const std::filesystem::path& model) {
    if (const auto found = opened_.find(model); found != opened_.end())
        return found->second;
    Opened opened;
    LoadOptions options;
    options.images.visual = false;
    opened.scene = loadScene(model, options);
    opened.workspaceFromScene = workspaceFromScene(*opened.scene, Fit::Workspace);
    opened.haptic =
        compileHapticScene(*opened.scene, opened.workspaceFromScene, {.rays = false, .progress = {}});
    return opened_.emplace(model, std::move(opened)).first->second;
}

StrokeDifference compareModels(const Condition& condition, double level, ModelStore& models,
                               const Stroke& stroke) {
    const auto& first = models.open(std::get<ModelStimulus>(condition.reference).model);
    const auto& second = models.open(std::get<ModelStimulus>(condition.comparison).model);
    const HapticSettings settings[2] = {settingsOf(condition, true, level),
                                        settingsOf(condition, false, level)};
    buildFor(*first.haptic, settings[0]);
    buildFor(*second.haptic, settings[1]);
    const std::vector<glm::dvec3> top = topOf(first, stroke);
    if (top.size() < 100)
        throw Error("observer", condition.name, "its stroke over the middle of the reference meets nothing",
                    "run this condition with people");
    SteppedHand hands[2] = {SteppedHand(*first.haptic, first.scene),
                            SteppedHand(*second.haptic, second.scene)};
    const double dt = 1.0 / stroke.rateHz, depth = stroke.force / kStiffness;
    const auto approach = static_cast<size_t>(kApproach * stroke.rateHz);
    glm::dvec3 mean(0.0), squares(0.0); // normal, tangential, across
    StrokeDifference sum;
    // Twice: to, and back.
    for (size_t tick = 0; tick < approach + 2 * top.size(); ++tick) {
        const bool touching = tick >= approach;
        const size_t at = touching ? tick - approach : 0;
        glm::dvec3 hand = top[at < top.size() ? at : 2 * top.size() - 1 - at];
        hand.y += touching
                      ? -depth
                      : 0.01 - (0.01 + depth) * static_cast<double>(tick) / static_cast<double>(approach);
        const double now = dt * static_cast<double>(tick);
        glm::dvec3 force[2], normal(0.0, 1.0, 0.0);
        for (const size_t i : {0u, 1u}) {
            const HapticOutput& felt = hands[i].tick(settings[i], sampleAt(hand), now, dt);
            force[i] = felt.force;
            if (i == 0 && felt.contacts > 0)
                normal = felt.normal;
        }
        if (!touching)
            continue;
        const glm::dvec3 along =
            glm::normalize(glm::dvec3(normal.y, -normal.x, 0.0) + glm::dvec3(1e-12, 0.0, 0.0));
        const glm::dvec3 across = glm::cross(normal, along), apart = force[1] - force[0];
        const glm::dvec3 difference(glm::dot(apart, normal), glm::dot(apart, along), glm::dot(apart, across));
        mean += difference;
        squares += difference * difference;
        ++sum.ticks;
    }
    const auto ticks = static_cast<double>(sum.ticks);
    const glm::dvec3 variance = glm::max(squares / ticks - (mean / ticks) * (mean / ticks), glm::dvec3(0.0));
    sum.normal = variance.x;
    sum.tangential = variance.y + variance.z;
    return sum;
}

} // namespace touchstone::experiment

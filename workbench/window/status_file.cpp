#include "workbench/window/status_file.h"

#include "engine/core/output_file.h"
#include "engine/core/realtime_guard.h"
#include "engine/scene/animation.h"
#include "engine/scene/scene.h"
#include "workbench/figures/settings_json.h"
#include "workbench/panels/error_panel.h"
#include "workbench/panels/panels.h"
#include "workbench/timeline/timeline_controller.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

constexpr const char* kPictureStates[]{"coarse", "refining", "kept"}; // by PictureState

nlohmann::ordered_json stagesJson(const ServoView& servo) {
    nlohmann::ordered_json json;
    for (size_t i = 0; i < kStageCount; ++i)
        json[std::string(kStageNames[i])] = {{"p50_us", servo.stageP50Us[i]},
                                             {"p99_us", servo.stageP99Us[i]}};
    json["step"] = {{"p50_us", servo.contactP50Us}, {"p99_us", servo.contactP99Us}};
    return json;
}

nlohmann::ordered_json errorJson(const study::LiveErrorFigures& error) {
    const auto pair = [](const study::LiveErrorFigures::Pair& p) {
        return nlohmann::ordered_json{{"p50", p.p50}, {"p99", p.p99}};
    };
    return {{"position_m", pair(error.position)},
            {"force_n", pair(error.force)},
            {"force_share", pair(error.forceShare)},
            {"direction_rad", pair(error.direction)},
            {"ticks_in_contact", error.inContact},
            {"contact_lost", error.lost},
            {"contact_invented", error.invented},
            {"compared_share", error.comparedShare},
            {"dropped", error.dropped},
            {"reference_step_ns", error.stepNs},
            {"below_perception", errorPerception(error).below()}};
}

nlohmann::ordered_json othersJson(const PanelInput& input) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const OtherHands::State& other : input.others) {
        const HapticOutput& tick = other.tick.output;
        all.push_back({{"name", other.name},
                       {"status", other.status},
                       {"valid", other.tick.sample.valid},
                       {"contacts", tick.contacts},
                       {"hip", {tick.hip.x, tick.hip.y, tick.hip.z}},
                       {"proxy", {tick.proxy.x, tick.proxy.y, tick.proxy.z}},
                       {"force_n", glm::length(tick.force)},
                       {"command_n", glm::length(tick.command.force())}});
    }
    return all;
}

nlohmann::ordered_json galleryJson(const PanelInput& input, const PanelState& state) {
    constexpr const char* kStates[]{"waiting", "shown", "none", "broken", "missing"}; // by GalleryState
    nlohmann::ordered_json entries = nlohmann::ordered_json::array();
    for (const GalleryEntry& entry : input.gallery)
        entries.push_back({{"file", entry.file.string()},
                           {"note", entry.note},
                           {"sample", entry.sample},
                           {"state", kStates[static_cast<size_t>(entry.state)]}});
    return {{"open", state.gallery}, {"at", state.galleryAt}, {"entries", std::move(entries)}};
}

nlohmann::ordered_json programsJson(const ProgramEditor& programs) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const EditedProgram& each : programs.sources())
        all.push_back({{"name", each.name},
                       {"file", each.file.string()},
                       {"compiles", each.program != nullptr},
                       {"edited", each.edited()},
                       {"overtaken", each.overtaken},
                       {"compiling", each.compiling},
                       {"problem", each.problem},
                       {"line", each.line},
                       {"fault", each.fault.problem},
                       {"fault_line", each.fault.line},
                       {"instructions", each.cost.instructions},
                       {"ns_per_tick", each.cost.ns},
                       {"ns_with_gradients", each.cost.nsWithGradients},
                       {"loads", each.loads},
                       {"felt_after_s", each.felt},
                       {"seen_after_s", each.seen}});
    return all;
}

/// `recent`: number of the last ticks of which the largest magnitudes are told, SI units.
nlohmann::ordered_json chartsJson(const PanelInput& input, const PanelState& state, size_t recent) {
    nlohmann::ordered_json shown = nlohmann::ordered_json::array(), peaks = nlohmann::ordered_json::object();
    const ForceHistory& history = *input.forces;
    for (size_t i = 0; i < kChartQuantityCount; ++i) {
        const ChartQuantity& quantity = chartQuantities()[i];
        if (state.charts[i])
            shown.push_back(quantity.name);
        float peak = 0.0f;
        for (size_t t = history.size() - std::min(recent, history.size()); t < history.size(); ++t)
            peak = std::max(peak, std::abs(history.at(t).*quantity.value));
        peaks[quantity.name] = peak;
    }
    return {{"shown", std::move(shown)},
            {"peaks", std::move(peaks)},
            {"height", state.folds.bottomHeight},
            {"saved", input.savedCharts.file.string()},
            {"problem", input.savedCharts.problem}};
}

/// What plays, by number, and where in it the servo is, s; null: nothing does.
nlohmann::ordered_json animationJson(const PanelInput& input, const PanelState& state) {
    const Animation* const animation = input.scene != nullptr ? playedAnimation(*input.scene) : nullptr;
    if (animation == nullptr)
        return {};
    const double time = input.servo->last.time;
    return {{"playing", animation - input.scene->animations.data()},
            {"at", loopedTime(*animation, animationTime(state.settings, time))},
            {"duration", animation->duration},
            {"speed", state.settings.animationSpeed}};
}

} // namespace

void StatusFile::update(double now, const PanelInput& input, const PanelState& state,
                        const std::map<std::string, WidgetRect>& widgets, const Screen& screen) {
    if (target_.empty())
        return;
    const ServoView& servo = *input.servo;
    const HapticOutput& tick = servo.last.output;
    const auto recentTicks = static_cast<size_t>(servo.rateHz * kLookBack);
    const ForceHistory::Entry recent = input.forces->mean(recentTicks);
    // The mouse has no clutch; it receives no force while it hovers.
    const bool mouse = state.device.empty() && !state.simulatedHand;
    nlohmann::ordered_json rects = nlohmann::ordered_json::object();
    for (const auto& [name, rect] : widgets)
        rects[name] = {{"x", rect.x},
                       {"y", rect.y},
                       {"width", rect.width},
                       {"height", rect.height},
                       {"note", rect.note}};
    const nlohmann::ordered_json json{
        {"update", ++updates_},
        {"model", input.modelName},
        {"loading", input.loading},
        {"problem", input.problem},
        {"recording",
         {{"on", input.recording}, {"file", input.recordingFile}, {"seconds", input.recordedSeconds}}},
        {"timeline", input.timeline->json()},
        {"list", {{"outcome", state.timeline.outcome}, {"failed", state.timeline.failed}}},
        {"notice", input.notice},
        {"warnings", input.warnings},
        {"materials",
         {{"edited", input.materialsEdited},
          {"working", input.materialsWorking},
          {"notice", input.materialNotice}}},
        {"programs", programsJson(screen.programs)},
        {"hand", state.simulatedHand ? "simulated" : "mouse"},
        {"workspace",
         {{"wanted_zoom", state.workspace.zoom},
          {"zoom", servo.last.sample.mapping.workspaceFromDevice.scale},
          {"clutch", !mouse && servo.last.sample.mapping.coupling < 1.0},
          {"coupling", servo.last.sample.mapping.coupling},
          {"text", mouse ? "" : workspaceText(servo.last.sample.mapping)}}},
        {"stroke",
         {{"name", state.stroke.name},
          {"speed", state.stroke.speed},
          {"depth", state.stroke.depth},
          {"notice", input.strokeNotice}}},
        {"mouse", {{"free", state.view.freeHand}, {"press_n", state.view.press}}},
        {"folded",
         {{"scene", state.folds.left}, {"felt", state.folds.right}, {"charts", state.folds.bottom}}},
        {"ui_scale", {{"asked", state.uiScale}, {"scale", input.scale}, {"fits", input.scaleFits}}},
        {"tooltip", state.hovered.shown},
        {"help", state.help},
        {"walking", state.walking},
        {"gallery", galleryJson(input, state)},
        {"leaving", state.leaving.has_value()},
        {"introduced", state.introduced},
        {"charts_paused", state.stopped.has_value()},
        {"charts", chartsJson(input, state, recentTicks)},
        {"sound",
         {{"on", state.sound.on},
          {"volume", state.sound.volume},
          {"state", input.sound.state},
          {"problem", input.sound.problem},
          {"card", input.sound.card},
          {"latency_s", input.sound.latency},
          {"peak", input.sound.peak},
          {"runs_dry", input.sound.runsDry},
          {"left_out", input.sound.leftOut}}},
        {"device", state.device},
        {"device_status", input.deviceStatus},
        {"other_hands", othersJson(input)},
        {"animation", animationJson(input, state)},
        {"settings", settingsJson(state.settings)},
        {"force_presses", input.forcePresses},
        {"force_key_late", input.forceKeyLate},
        {"typing", input.typing},
        {"tick",
         {{"time", servo.last.time},
          {"contacts", tick.contacts},
          {"friction_state", static_cast<unsigned>(tick.friction)},
          {"hip", {tick.hip.x, tick.hip.y, tick.hip.z}},
          {"proxy", {tick.proxy.x, tick.proxy.y, tick.proxy.z}},
          {"force", {tick.force.x, tick.force.y, tick.force.z}},
          {"command_n", glm::length(tick.command.force())}}},
        {"recent",
         {{"in_contact", recent.contact},
          {"mean_force_n", recent.force},
          {"mean_tangential_force_n", recent.tangential}}},
        {"servo",
         {{"ticks", servo.counters.ticks},
          {"missed", servo.counters.missed},
          {"start_s", input.servoStart},
          {"ticks_per_second", servo.ticksPerSecond},
          {"wake_p50_us", servo.wakeP50Us},
          {"wake_p99_us", servo.wakeP99Us},
          {"step_p99_us", servo.stepP99Us},
          {"scheduling", servo.scheduling}}},
        {"stages", stagesJson(servo)},
        {"error", errorJson(servo.error)},
        {"allocations_in_tick", realtime::violations().allocations},
        {"view",
         {{"mode", viewModeName(state.view.mode)},
          {"hidden", state.view.part.hidden},
          {"felt_hidden", input.part.hidden},
          {"clipped", input.part.clip.has_value()},
          {"clip_offset",
           input.part.clip ? nlohmann::ordered_json(input.part.clip->offset) : nlohmann::ordered_json()},
          {"iso", input.scene != nullptr && input.scene->volume != nullptr
                      ? nlohmann::ordered_json(input.scene->iso)
                      : nlohmann::ordered_json()},
          {"wireframe", state.view.wireframe},
          {"grid", state.view.grid},
          {"slice", {{"axis", state.view.slice.axis}, {"at", state.view.slice.at}}},
          {"orthographic", state.view.orthographic},
          {"turntable", state.view.turntable},
          {"magnifier", state.view.magnifier},
          {"overlays", state.view.overlays.probe},
          {"picture", input.savedPicture.text()},
          {"yaw", input.camera.yaw},
          {"pitch", input.camera.pitch},
          {"distance", input.camera.distance},
          {"target", {input.camera.target.x, input.camera.target.y, input.camera.target.z}}}},
        {"time", now},
        {"frames", input.frames},
        {"fps", input.framesPerSecond},
        {"longest_frame_s", input.longestFrame},
        {"scene_size", {input.sceneSize.x, input.sceneSize.y}},
        {"gpu", input.gpuName},
        {"picture",
         {{"state", kPictureStates[static_cast<size_t>(screen.drawn.state)]},
          {"frames", screen.drawn.frames},
          {"refined_in_s", screen.drawn.refinedIn},
          {"other_materials", screen.otherMaterials}}},
        {"validation_messages", screen.validationMessages},
        {"widgets", rects},
    };
    writeFile(target_, json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

} // namespace touchstone

#include "workbench/timeline/timeline_controller.h"

#include "engine/import/volume_file/volume_edits.h"
#include "haptics/world/world_state.h"
#include "workbench/figures/quantity.h"
#include "workbench/timeline/recording_files.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <exception>
#include <new>
#include <system_error>

namespace touchstone {

void TimelineController::open(const std::filesystem::path& file) {
    opening_.abandon();
    pending_ = openingFile_ = file;
}

void TimelineController::demandUnused(const std::filesystem::path& file) const {
    const auto refuse = [&](const char* problem, const char* remedy) {
        throw Error(file.filename().string(), "", problem, remedy);
    };
    // By whatever path, or through a link.
    const auto same = [&](const std::filesystem::path& other) {
        std::error_code none;
        return other == file || std::filesystem::equivalent(other, file, none);
    };
    if (looking() && same(timeline_->file()))
        refuse("is open", "go back to the live hand first");
    if (opening() && same(openingFile_))
        refuse("is being opened", "cancel that first");
    if (same(recorded_))
        refuse("is being recorded", "stop the recording first");
}

void TimelineController::rename(const std::filesystem::path& file, std::string_view name) {
    demandUnused(file);
    list_.moved(file, renameRecording(file, name));
}

void TimelineController::remove(const std::filesystem::path& file) {
    demandUnused(file);
    deleteRecording(file);
    list_.moved(file, {});
}

void TimelineController::cancelOpening() {
    opening_.abandon();
    pending_.clear();
}

TimelineController::Opened TimelineController::read(const std::filesystem::path& file,
                                                    JobProgress& progress) {
    Opened opened;
    opened.timeline = std::make_shared<const Timeline>(Timeline::load(file, progress));
    for (const auto& [number, scene] : opened.timeline->scenes())
        if (const std::optional<std::filesystem::path> found = findRecordedScene(file, scene.identity)) {
            std::error_code error;
            const std::filesystem::path canonical = std::filesystem::weakly_canonical(*found, error);
            opened.files[number] = error ? *found : canonical;
        }
    return opened;
}

void TimelineController::takeOpened() {
    try {
        if (std::optional<Opened> opened = opening_.take())
            look(std::move(*opened));
        if (!pending_.empty() && !opening_.busy())
            opening_.start(
                [file = std::exchange(pending_, {})](JobProgress& progress) { return read(file, progress); });
    } catch (const Error& error) {
        problem_ = error;
    } catch (const std::bad_alloc&) {
        problem_ = Error(openingFile_.string(), "", "there is not enough memory for it", "");
    } catch (const std::exception& error) {
        problem_ = Error(openingFile_.string(), "", error.what(), "");
    }
}

void TimelineController::retire() {
    again_.stop();
    again_.clear();
    comparison_.want(false);
    verifying_.abandon();
    verifyWanted_ = false;
    if (replayCache_ != nullptr)
        retired_.push_back(std::move(replayCache_));
    verdictText_.clear();
    lensProblem_.clear();
    againProblem_.clear();
    notes_.clear();
    tick_ = TickRecord{};
    complete_.reset();
    fit_ = ModelFit::None;
}

void TimelineController::look(Opened opened) {
    retire();
    timeline_ = std::move(opened.timeline);
    files_ = std::move(opened.files);
    playback_.emplace(timeline_);
    shelf_ = std::make_shared<RecordedSceneShelf>(timeline_->file());
    replayCache_ = std::make_unique<ReplayCache>(timeline_, shelf_);
    last_ = -1.0;
    modelWanted_.reset();
    if (const auto file = modelFile())
        modelWanted_ = file; // update() clears it where it is open
}

void TimelineController::leave() {
    retire();
    playback_.reset();
    timeline_.reset();
    modelWanted_.reset();
}

std::optional<std::filesystem::path> TimelineController::modelFile() const {
    // A recording may start without a scene.
    size_t index = playback_->cursor();
    for (const TimelineMark& mark : timeline_->marks())
        if (timeline_->sceneOf(index) == 0 && mark.kind == TimelineMark::Kind::Scene && mark.index > index)
            index = std::min(mark.index, timeline_->size() - 1);
    const auto file = files_.find(timeline_->sceneOf(index));
    return file != files_.end() ? std::optional(file->second) : std::nullopt;
}

void TimelineController::update(const Surroundings& around) {
    std::erase_if(retired_,
                  [](const std::unique_ptr<ReplayCache>& replayCache) { return replayCache->finished(); });
    recorded_ = around.recorded;
    if (around.listed)
        list_.update(around.now);
    takeOpened();
    try {
        if (std::optional<Verdict> verdict = verifying_.take()) {
            verdictText_ = verdict->text();
            verdictEqual_ = verdict->equal();
        }
    } catch (const std::exception& error) {
        verdictText_ = error.what();
        verdictEqual_ = false;
    }
    if (!looking())
        return;
    if (verifyWanted_ && !verifying_.busy()) {
        verifyWanted_ = false;
        verifying_.start([timeline = timeline_, shelf = shelf_](JobProgress& progress) {
            return touchstone::verify(*timeline, *shelf, progress);
        });
    }
    if (around.settings != nullptr)
        comparison_.update(timeline_, shelf_, *around.settings);
    try {
        again_.update(*around.live, around.servoTime);
    } catch (const std::exception& error) {
        againProblem_ = error.what();
    }
    if (again_.running()) {
        playback_->play(false);
        if (again_.seconds())
            playback_->seek(*again_.seconds());
    } else if (last_ >= 0.0) {
        playback_->advance(around.now - last_);
    }
    last_ = around.now;
    fitModel(around);
    showTick();
}

void TimelineController::showTick() {
    try {
        replayCache_->look(playback_->cursor());
    } catch (const std::exception& error) {
        lensProblem_ = error.what();
    }
    const size_t cursor = playback_->cursor();
    if (!replayCache_->show(cursor, tick_))
        return;
    complete_ = replayCache_->complete(cursor) ? std::optional(cursor) : std::nullopt;
    HapticOutput& output = tick_.output;
    for (glm::dvec3* place : {&output.hip, &output.proxy, &output.stictionPoint})
        *place = openFromRecorded_.point(*place);
    const std::vector<body::Pose>* const bodies = replayCache_->bodies(cursor);
    bodies_ = bodies != nullptr ? *bodies : std::vector<body::Pose>();
    for (body::Pose& body : bodies_)
        body = {openFromRecorded_.rotation * body.rotation, openFromRecorded_.point(body.position)};
    const std::span<const DrivenPose> moved = replayCache_->moved(cursor);
    moved_.assign(moved.begin(), moved.end());
    for (DrivenPose& object : moved_)
        object.now = openFromRecorded_ * object.now;
}

TimelineController::ModelFit TimelineController::fitOf(const RecordedScene& scene,
                                                       const SceneIdentity* open) const {
    const SceneIdentity& recorded = scene.identity;
    const auto file = files_.find(scene.number);
    const bool found = file != files_.end();
    if (open != nullptr && open->feltHash == recorded.feltHash && open->fit == recorded.fit)
        return ModelFit::Open;
    if (open != nullptr && found && file->second == open->absolutePath)
        return open->fileHash == recorded.fileHash ? ModelFit::Open : ModelFit::Changed;
    return found ? ModelFit::Other : ModelFit::Missing;
}

void TimelineController::fitModel(const Surroundings& around) {
    const auto scene = timeline_->scenes().find(timeline_->sceneOf(playback_->cursor()));
    const RecordedScene* const recorded = scene != timeline_->scenes().end() ? &scene->second : nullptr;
    fit_ = recorded != nullptr ? fitOf(*recorded, around.open) : ModelFit::None;
    openFromRecorded_ = Similarity{};
    period_ = 0.0;
    if (around.model != nullptr && around.model->scene != nullptr && modelIsOpen()) {
        const Scene& open = *around.model->scene;
        if (recorded != nullptr && recorded->identity.fit != around.open->fit)
            openFromRecorded_ =
                around.model->workspaceFromScene * workspaceFromScene(open, recorded->identity.fit).inverse();
        if (const Animation* animation = playedAnimation(open))
            period_ = animation->duration;
    }
    if (modelWanted_ && around.open != nullptr && *modelWanted_ == around.open->absolutePath)
        modelWanted_.reset();
    describe(recorded, around.model);
}

void TimelineController::describe(const RecordedScene* scene, const Model* open) {
    notes_.clear();
    if (scene != nullptr) {
        const std::string name = std::filesystem::path(scene->identity.path).filename().string();
        if (fit_ == ModelFit::Missing)
            notes_.push_back(scene->identity.absolutePath +
                             " was touched and is not there: only the curves are shown. Put it beside the "
                             "recording to see it.");
        else if (fit_ == ModelFit::Other)
            notes_.push_back(name + " was touched and is not open: only the curves are shown");
        else if (fit_ == ModelFit::Changed)
            notes_.push_back(name + " has changed since it was touched");
        std::string materials = scene->identity.edits;
        const std::optional<double> iso = takeIso(materials);
        (void)takeAnimation(materials);
        (void)takeLoose(materials);
        if (fit_ != ModelFit::Missing && !materials.empty())
            notes_.emplace_back("its materials had been edited and not saved");
        if (iso && modelIsOpen() && open != nullptr && open->scene != nullptr &&
            open->scene->volume != nullptr && open->scene->iso != *iso)
            notes_.push_back("it was touched with the surface at " + figure(*iso, 6));
        if (fit_ != ModelFit::Missing && !scene->identity.part.whole())
            notes_.emplace_back("a part of it was hidden or clipped");
    }
    for (const std::string* problem : {&lensProblem_, &againProblem_})
        if (!problem->empty())
            notes_.push_back(*problem);
    if (fit_ != ModelFit::Missing && replayCache_ != nullptr && !replayCache_->problem().empty())
        notes_.push_back(replayCache_->problem());
    notes_.insert(notes_.end(), timeline_->warnings().begin(), timeline_->warnings().end());
}

void TimelineController::verify() {
    verifying_.abandon();
    verdictText_.clear();
    verifyWanted_ = true;
}

void TimelineController::touchAgain() {
    againProblem_.clear();
    again_.start(timeline_, {.first = playback_->first(),
                             .last = playback_->last(),
                             .repeats = playback_->loops(),
                             .deviceFromRecorded = openFromRecorded_,
                             .period = period_});
}

nlohmann::ordered_json TimelineController::json() const {
    nlohmann::ordered_json json{{"looking", looking()}, {"opening", opening()}};
    nlohmann::ordered_json listed = nlohmann::ordered_json::array();
    for (const RecordingFacts& facts : list_.recordings())
        listed.push_back({{"file", facts.file.string()},
                          {"date", facts.date},
                          {"model", facts.model},
                          {"seconds", facts.seconds},
                          {"reason", facts.reason},
                          {"problem", facts.problem}});
    json["list"] = std::move(listed);
    if (!looking())
        return json;
    const Playback& at = *playback_;
    json["file"] = timeline_->file().string();
    json["length_s"] = timeline_->length();
    json["ticks"] = timeline_->size();
    json["cursor_tick"] = at.cursor();
    json["cursor_s"] = at.seconds();
    json["playing"] = at.playing();
    json["speed"] = at.speed();
    json["loops"] = at.loops();
    json["begin_tick"] = at.first();
    json["end_tick"] = at.last();
    json["model_is_open"] = modelIsOpen();
    json["tick_complete"] = tickComplete();
    const HapticOutput& shown = tick_.output;
    json["tick"] = {{"number", tick_.tick},
                    {"contacts", shown.contacts},
                    {"planes", shown.planeCount},
                    {"proxy", {shown.proxy.x, shown.proxy.y, shown.proxy.z}},
                    {"force", {shown.force.x, shown.force.y, shown.force.z}}};
    json["bodies"] = nlohmann::ordered_json::array();
    for (const body::Pose& body : bodies_)
        json["bodies"].push_back({body.position.x, body.position.y, body.position.z});
    json["moved"] = nlohmann::ordered_json::array();
    for (const DrivenPose& object : moved_) {
        const glm::dvec3& place = object.now.translation;
        json["moved"].push_back({{"object", object.object}, {"position", {place.x, place.y, place.z}}});
    }
    json["force_n"] = timeline_->force()[at.cursor()];
    json["marks"] = timeline_->marks().size();
    json["notes"] = notes_;
    json["verifying"] = verifying() || verifyWanted_;
    json["verified"] = verdictText_.empty()
                           ? nlohmann::ordered_json(nullptr)
                           : nlohmann::ordered_json{{"equal", verdictEqual_}, {"text", verdictText_}};
    const ComparedTouch* const compared = comparison_.result();
    json["comparison"] = {
        {"wanted", comparison_.wanted()}, {"busy", comparison_.busy()}, {"problem", comparison_.problem()}};
    if (compared != nullptr) {
        json["comparison"]["change"] = compared->change;
        json["comparison"]["figures"] = compared->figures.json();
    }
    const TouchAgain::Means means = again_.means();
    json["again"] = {{"running", again_.running()},
                     {"ticks", means.ticks},
                     {"recorded_n", means.recorded},
                     {"now_n", means.now}};
    return json;
}

} // namespace touchstone

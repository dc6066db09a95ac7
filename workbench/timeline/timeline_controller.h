#pragma once
// Playback of recordings without its user interface: the open recording, the cursor, the felt tick, and the
// result of touching it again.

#include "engine/core/error.h"
#include "workbench/model/model.h"
#include "workbench/timeline/playback.h"
#include "workbench/timeline/recording_list.h"
#include "workbench/timeline/replay_cache.h"
#include "workbench/timeline/settings_comparison.h"
#include "workbench/timeline/touch_again.h"
#include "workbench/timeline/verification.h"

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone {

/// Main thread; workers do everything that takes time.
class TimelineController {
  public:
    /// `hand`: the servo's. `folders`: listed recordings.
    TimelineController(PlaybackDevice& hand, std::vector<std::filesystem::path> folders)
        : list_(std::move(folders)), again_(hand) {}

    /// Reads the file on a worker. The current recording stays until it is ready.
    void open(const std::filesystem::path& file);
    void cancelOpening();
    [[nodiscard]] bool opening() const { return opening_.wanted() || !pending_.empty(); }
    [[nodiscard]] const std::filesystem::path& openingFile() const { return openingFile_; }
    [[nodiscard]] double openingFraction() const { return opening_.fraction(); }

    /// Inputs from the rest of the window in this frame.
    struct Surroundings {
        double now = 0.0;                    ///< s, any steady clock
        const Model* model = nullptr;        ///< the open model; null: none
        const SceneIdentity* open = nullptr; ///< of the open model
        const ForceHistory* live = nullptr;
        double servoTime = 0.0;                   ///< s, of the latest tick
        const HapticSettings* settings = nullptr; ///< the chosen ones, to compare with; null: none
        bool listed = false;                      ///< the list of recordings is shown
        std::filesystem::path recorded = {};      ///< being recorded; empty: none
    };
    void update(const Surroundings& around);

    /// A recording is shown: the live hand's force must be off.
    [[nodiscard]] bool looking() const { return timeline_ != nullptr; }
    /// Back to the live hand.
    void leave();

    /// The recorded model that is not open; returned once.
    [[nodiscard]] std::optional<std::filesystem::path> takeModelWanted() {
        return std::exchange(modelWanted_, std::nullopt);
    }
    /// Why a recording could not be opened; returned once.
    [[nodiscard]] std::optional<Error> takeProblem() { return std::exchange(problem_, std::nullopt); }

    // While looking():
    [[nodiscard]] const Timeline& timeline() const { return *timeline_; }
    [[nodiscard]] Playback& playback() { return *playback_; }
    [[nodiscard]] const Playback& playback() const { return *playback_; }
    /// The tick under the cursor, in the workspace of the open model; while it is being read, the last known
    /// one.
    [[nodiscard]] const TickRecord& tick() const { return tick_; }
    /// The bodies after that tick, in the workspace of the open model; empty where the recording has none,
    /// or they are not known yet.
    [[nodiscard]] const std::vector<body::Pose>& bodies() const { return bodies_; }
    /// The same of the objects that a caller moved.
    [[nodiscard]] const std::vector<DrivenPose>& moved() const { return moved_; }
    /// It is the cursor's tick, with the recomputed data.
    [[nodiscard]] bool tickComplete() const { return complete_ == playback_->cursor(); }
    [[nodiscard]] const HapticSettings& settings() const {
        return timeline_->settingsOf(playback_->cursor());
    }
    /// The recorded model is open: the tick may be drawn on it.
    [[nodiscard]] bool modelIsOpen() const { return fit_ != ModelFit::Missing && fit_ != ModelFit::Other; }
    [[nodiscard]] std::optional<std::filesystem::path>
    modelFile() const; ///< under the cursor; its current path
    void wantModel() { modelWanted_ = modelFile(); }
    /// Notices about what is shown, one sentence each.
    [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

    void verify();
    void cancelVerifying() { verifying_.abandon(); }
    [[nodiscard]] bool verifying() const { return verifying_.wanted(); }
    [[nodiscard]] double verifyingFraction() const { return verifying_.fraction(); }
    /// The result as a sentence; empty: none yet.
    [[nodiscard]] const std::string& verdict() const { return verdictText_; }
    [[nodiscard]] bool verdictEqual() const { return verdictEqual_; }

    /// Replays the recorded hand through the live servo, between the marks or from start to end.
    void touchAgain();
    void stopTouchingAgain() { again_.stop(); }
    [[nodiscard]] const TouchAgain& again() const { return again_; }

    /// Whether the recording is compared with the chosen settings.
    void compare(bool wanted) { comparison_.want(wanted); }
    [[nodiscard]] const SettingsComparison& comparison() const { return comparison_; }

    [[nodiscard]] const RecordingList& list() const { return list_; }
    /// Of a file of the list, as renameRecording and deleteRecording. Throws Error, also where it is looked
    /// at or being recorded.
    void rename(const std::filesystem::path& file, std::string_view name);
    void remove(const std::filesystem::path& file);
    /// For `--status-json`.
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    enum class ModelFit : uint8_t { None, Open, Changed, Other, Missing };
    struct Opened {
        std::shared_ptr<const Timeline> timeline;
        /// Current canonical paths of the scene files; empty: missing.
        std::map<uint32_t, std::filesystem::path> files;
    };
    static Opened read(const std::filesystem::path& file, JobProgress& progress);

    void takeOpened();
    void look(Opened opened);
    void fitModel(const Surroundings& around);
    [[nodiscard]] ModelFit fitOf(const RecordedScene& scene, const SceneIdentity* open) const;
    void describe(const RecordedScene* scene, const Model* open);
    void showTick();
    void retire();
    void demandUnused(const std::filesystem::path& file) const;

    RecordingList list_;
    std::filesystem::path recorded_;
    BackgroundJob<Opened> opening_;
    std::filesystem::path openingFile_, pending_;
    std::shared_ptr<const Timeline> timeline_;
    std::map<uint32_t, std::filesystem::path> files_;
    std::shared_ptr<RecordedSceneShelf> shelf_;
    std::optional<Playback> playback_;
    std::unique_ptr<ReplayCache> replayCache_;
    std::vector<std::unique_ptr<ReplayCache>> retired_; // still working
    std::string lensProblem_;
    TickRecord tick_;
    std::vector<body::Pose> bodies_;
    std::vector<DrivenPose> moved_;
    std::optional<size_t> complete_; // the tick in tick_, if complete
    ModelFit fit_ = ModelFit::None;
    Similarity openFromRecorded_; // workspaces
    double period_ = 0.0;         // s, of the open model's animation
    std::optional<std::filesystem::path> modelWanted_;
    std::optional<Error> problem_;
    std::vector<std::string> notes_;
    BackgroundJob<Verdict> verifying_;
    bool verifyWanted_ = false;
    std::string verdictText_;
    bool verdictEqual_ = false;
    SettingsComparison comparison_;
    TouchAgain again_;
    std::string againProblem_;
    double last_ = -1.0; // s, of the last update
};

} // namespace touchstone

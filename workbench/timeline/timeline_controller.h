#pragma once
// Everything about looking at a recording, without a pixel of it: which one is open, where the cursor is,
// what was felt there, and what touching it again comes to.

#include "engine/core/error.h"
#include "workbench/model/model.h"
#include "workbench/timeline/playback.h"
#include "workbench/timeline/recording_list.h"
#include "workbench/timeline/replay_cache.h"
#include "workbench/timeline/touch_again.h"
#include "workbench/timeline/verification.h"

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace touchstone {

/// Main thread; all that takes time is done by workers.
class TimelineController {
  public:
    /// `hand` is what the servo touches with. The recordings of `folders` are listed.
    TimelineController(PlaybackDevice& hand, std::vector<std::filesystem::path> folders)
        : list_(std::move(folders)), again_(hand) {}

    /// Reads the file on a worker. What is looked at stays until it is there.
    void open(const std::filesystem::path& file);
    void cancelOpening();
    [[nodiscard]] bool opening() const { return opening_.wanted() || !pending_.empty(); }
    [[nodiscard]] const std::filesystem::path& openingFile() const { return openingFile_; }
    [[nodiscard]] double openingFraction() const { return opening_.fraction(); }

    /// What is around it in this frame.
    struct Surroundings {
        double now = 0.0;                    ///< s, any steady clock
        const Model* model = nullptr;        ///< that is open; null: none
        const SceneIdentity* open = nullptr; ///< of the same
        const ForceHistory* live = nullptr;
        double servoTime = 0.0; ///< s, of the newest tick
        bool listed = false;    ///< the list of recordings is shown
    };
    void update(const Surroundings& around);

    /// A recording is looked at: the live hand's force is to be off.
    [[nodiscard]] bool looking() const { return timeline_ != nullptr; }
    /// Back to the live hand.
    void leave();

    /// The model that was touched and is not open; told once.
    [[nodiscard]] std::optional<std::filesystem::path> takeModelWanted() {
        return std::exchange(modelWanted_, std::nullopt);
    }
    /// Why a recording could not be opened; told once.
    [[nodiscard]] std::optional<Error> takeProblem() { return std::exchange(problem_, std::nullopt); }

    // While looking:
    [[nodiscard]] const Timeline& timeline() const { return *timeline_; }
    [[nodiscard]] Playback& playback() { return *playback_; }
    [[nodiscard]] const Playback& playback() const { return *playback_; }
    /// The tick under the cursor, in the workspace of the model that is open; the last one that was known
    /// while it is being read.
    [[nodiscard]] const TickRecord& tick() const { return tick_; }
    /// It is that of the cursor, with what a recording does not keep.
    [[nodiscard]] bool tickComplete() const { return complete_ == playback_->cursor(); }
    [[nodiscard]] const HapticSettings& settings() const {
        return timeline_->settingsOf(playback_->cursor());
    }
    /// The model that was touched is open: the tick belongs on its picture.
    [[nodiscard]] bool modelIsOpen() const { return fit_ != ModelFit::Missing && fit_ != ModelFit::Other; }
    [[nodiscard]] std::optional<std::filesystem::path>
    modelFile() const; ///< under the cursor; where it is now
    void wantModel() { modelWanted_ = modelFile(); }
    /// What a person must know of what is shown, one sentence each.
    [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

    void verify();
    void cancelVerifying() { verifying_.abandon(); }
    [[nodiscard]] bool verifying() const { return verifying_.wanted(); }
    [[nodiscard]] double verifyingFraction() const { return verifying_.fraction(); }
    /// What came of it, as a sentence; empty: nothing yet.
    [[nodiscard]] const std::string& verdict() const { return verdictText_; }
    [[nodiscard]] bool verdictEqual() const { return verdictEqual_; }

    /// The recorded hand, between the marks or from begin to end, through the servo of now.
    void touchAgain();
    void stopTouchingAgain() { again_.stop(); }
    [[nodiscard]] const TouchAgain& again() const { return again_; }

    [[nodiscard]] const RecordingList& list() const { return list_; }
    /// For `--status-json`.
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    enum class ModelFit : uint8_t { None, Open, Changed, Other, Missing };
    struct Opened {
        std::shared_ptr<const Timeline> timeline;
        /// Where the scenes' files are now, canonical; empty: nowhere.
        std::map<uint32_t, std::filesystem::path> files;
    };
    static Opened read(const std::filesystem::path& file, JobProgress& progress);

    void takeOpened();
    void look(Opened opened);
    void fitModel(const Surroundings& around);
    [[nodiscard]] ModelFit fitOf(const RecordedScene& scene, const SceneIdentity* open) const;
    void describe(const RecordedScene* scene);
    void showTick();
    void retire();

    RecordingList list_;
    BackgroundJob<Opened> opening_;
    std::filesystem::path openingFile_, pending_;
    std::shared_ptr<const Timeline> timeline_;
    std::map<uint32_t, std::filesystem::path> files_;
    std::shared_ptr<RecordedSceneShelf> shelf_;
    std::optional<Playback> playback_;
    std::unique_ptr<ReplayCache> replayCache_;
    std::vector<std::unique_ptr<ReplayCache>> retired_; // still at work
    std::string lensProblem_;
    TickRecord tick_;
    std::optional<size_t> complete_; // the tick that tick_ is, where nothing of it is missing
    ModelFit fit_ = ModelFit::None;
    Similarity openFromRecorded_; // workspaces
    double period_ = 0.0;         // s, of what moves in the open model
    std::optional<std::filesystem::path> modelWanted_;
    std::optional<Error> problem_;
    std::vector<std::string> notes_;
    BackgroundJob<Verdict> verifying_;
    bool verifyWanted_ = false;
    std::string verdictText_;
    bool verdictEqual_ = false;
    TouchAgain again_;
    std::string againProblem_;
    double last_ = -1.0; // s, of the last update
};

} // namespace touchstone

#pragma once
// Repeats a recorded touch and compares the results.

#include "haptics/recording/edited_scene.h"
#include "haptics/recording/recording_reader.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/scene/scene_sculptor.h"
#include "haptics/tick/haptic_step.h"
#include "haptics/world/world_state.h"

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace touchstone {

/// A scene for the replay.
struct ReplayScene {
    std::shared_ptr<const HapticScene> haptic;
    ScenePtr source; ///< whose animation moves the objects
};

/// The first difference between a replay and its recording.
struct Difference {
    uint64_t tick = 0;
    double time = 0.0;
    uint32_t hand = 0; ///< TickRecord::hand; 0 with "poses"
    /// One of kStageNames; "contact location" where a display shows another place; "state" where a hand's
    /// checkpoint differs from its state after the preceding ticks; "poses" where the objects are elsewhere;
    /// "field" where a sculpted scene has other fields.
    std::string stage;
    glm::dvec3 recordedProxy{0.0}, replayedProxy{0.0}; ///< m, workspace
    glm::dvec3 recordedForce{0.0}, replayedForce{0.0}; ///< N, stage 7
};

struct ReplayReport {
    RecordingOrigin origin;
    uint64_t ticks = 0;     ///< in the recording
    uint64_t replayed = 0;  ///< those whose state was known
    uint64_t differing = 0; ///< of those: at least one stage of a hand differs, or a pose
    size_t hands = 1;
    uint64_t lost = 0; ///< made but not recorded, as far as the recording contains
    uint64_t gaps = 0; ///< places where ticks are missing
    std::optional<Difference> first;
    std::vector<RecordedNote> notes;
    std::vector<std::string> damage;
    bool cutOff = false;
    double seconds = 0.0; ///< from the first to the last replayed tick, on the recording's clock
};

/// "of hand 2, " where one of several hands differs (they count from 1 here); else empty.
[[nodiscard]] std::string whichHand(const ReplayReport& report);

/// One thread; not the servo. Deterministic for the same scene, program and processor.
class Replayer {
  public:
    /// `load` is called once for each scene of the recording, before its first tick; an exception from it
    /// ends the replay.
    using Load = std::function<ReplayScene(const RecordedScene&)>;
    /// Called for every replayed tick of hand 0, with its output; `equal`: all of this hand's stages.
    using Each = std::function<void(const RecordedTick&, const HapticOutput&, int64_t stepNs, bool equal)>;

    /// Other settings in place of the recorded ones.
    using Change = std::function<HapticSettings(const HapticSettings&)>;

    explicit Replayer(Load load) : load_(std::move(load)) {}
    /// What other settings make of the recorded path: nothing is compared (`equal` is false, the report has
    /// no difference). The recorded state is taken where there is none of its own: at the start, after a gap
    /// and where the scene changes.
    Replayer(Load load, Change change) : load_(std::move(load)), change_(std::move(change)) {}

    /// Replays to the end of the file. After a gap it resumes at the next checkpoint. Where the replay
    /// differs from the recording it takes the recorded state at the next checkpoint, so that one rounding
    /// does not affect the rest. Throws Error where the recording contradicts itself or no checkpoint fits
    /// this version.
    [[nodiscard]] ReplayReport replay(RecordingReader& reader, const Each& each = {});

    /// The same item by item, for callers that read only a part: scenes and settings that the ticks name, the
    /// checkpoint at the start, then the ticks. `each` must outlive the last `take`.
    void begin(const Each& each);
    void take(const RecordingReader::Item& item);
    [[nodiscard]] const ReplayReport& report() const { return report_; }
    /// In `each`: the bodies after that tick; null where the scene has none.
    [[nodiscard]] const body::BodyWorld* bodies() const;
    /// In `each`: the objects that a caller moved, after that tick.
    [[nodiscard]] std::span<const DrivenPose> moved() const;

  private:
    /// Of the scene that is replayed; null before the first.
    [[nodiscard]] const WorldState* rootWorld() const;
    struct Touched {
        ReplayScene scene;
        WorldState world;
    };
    void take(const RecordingOrigin& origin);
    void take(const RecordedScene& scene);
    void take(const RecordedSettings& settings);
    void take(const TouchCheckpoint& checkpoint);
    void take(const RecordedTicks& ticks);
    void take(const RecordedLoss& loss);
    void take(const RecordedNote& note);
    void take(const RecordedEnd&) {}
    void take(const RecordedHandTicks& ticks);
    void take(const RecordedHandState& state);
    void take(const RecordedTool& tool) { tool_ = tool.tool; }
    void take(const RecordedSculpt& sculpt);
    void take(const RecordedContacts& contacts);
    void take(const RecordedBodies& bodies);
    void take(const RecordedTextures& textures);
    void take(const RecordedStrokes& strokes);
    void take(const RecordedLocations& locations);
    void take(const RecordedDriven& driven);

    void lose();
    void resume(const RecordedTick& tick);
    [[nodiscard]] bool gather(const RecordedTick& tick);
    void step(const RecordedTick& tick);
    struct FeltTick {
        double animated = 0.0; // time of the objects' motion
        int64_t stepNs = 0;
        uint32_t poses = 0; // WorldState::poseHash
        bool texturesEqual = true;
    };
    [[nodiscard]] FeltTick feel(const RecordedTick& tick, const HapticSettings& settings, Touched* touched);
    [[nodiscard]] bool sameLocation(uint32_t hand, const RecordedTick& tick, const HapticSettings& settings);
    [[nodiscard]] bool compare(uint32_t hand, const RecordedTick& tick);
    void differs(const Difference& difference);
    [[nodiscard]] Touched* touched(uint32_t number);
    [[nodiscard]] Touched* sculpted(uint32_t number);
    [[nodiscard]] uint32_t rootOf(uint32_t scene) const;
    bool takeUp(const RecordedTick& tick);
    void putDriven(const RecordedTick& tick, Touched& touched) const;
    [[nodiscard]] bool restoreTextures(const RecordedTick& tick, PersistentTextures& textures) const;
    [[nodiscard]] bool sameStrokes(const RecordedTick& tick, const PersistentTextures* textures);

    Load load_;
    Change change_; ///< empty: the recorded settings
    const Each* each_ = nullptr;
    ReplayReport report_;
    std::map<uint32_t, RecordedScene> scenes_;
    std::map<uint32_t, std::unique_ptr<Touched>> loaded_;
    std::map<uint32_t, HapticSettings> settings_;
    LiveTool tool_;
    std::map<uint32_t, EditedScene> sculpted_;              // scenes that are edits of others
    std::map<uint32_t, std::vector<SculptEntry>> journals_; // by root
    /// The root's scene after some entries: that of one number at a time.
    struct Edited {
        SceneSculptor sculptor;
        size_t applied = 0;
        uint32_t number = 0;
        Touched touched;
    };
    std::map<uint32_t, std::unique_ptr<Edited>> edited_;       // by root
    std::optional<TouchCheckpoint> checkpoint_;                // of the next tick and hand 0
    std::map<uint32_t, TouchCheckpoint> otherStates_;          // of the same tick, by hand
    std::map<uint32_t, std::deque<RecordedTick>> others_;      // of the next ticks, by hand
    std::array<std::map<uint64_t, PadTick>, kMaxHands> shown_; // of the next ticks, by hand and tick
    std::map<uint64_t, uint32_t> found_;                       // RecordedTick::found of the next ticks
    std::optional<RecordedBodies> bodies_;                     // of the next tick
    std::vector<RecordedTextures> textures_;                   // the last whole state, in its parts
    std::vector<BrushStroke> strokes_;                         // since
    size_t nextStroke_ = 0;                                    // in `strokes_`: of the next tick
    std::map<uint64_t, DrivenState> driven_;                   // what callers move, before the next ticks
    // Present state of the replay.
    bool known_ = false; // the state is that of the recording's last tick
    uint32_t scene_ = 0;
    double previousTime_ = 0.0;
    // One per hand, of this tick:
    std::vector<DeviceState> devices_{1};
    std::vector<LocationLimiterState> pads_{1};
    std::vector<RecordedTick> ticks_{1};
    std::vector<DeviceSample> samples_{1};
    std::vector<HapticOutput> outputs_{1};
    std::vector<StageTrace> traces_{1};
};

} // namespace touchstone

#pragma once
// What `touch` does tick by tick, and its recording.

#include "devices/plant/hand_impedance.h"
#include "devices/simulated/told_hand.h"
#include "haptics/body/joint_settings.h"
#include "haptics/recording/recording_writer.h"
#include "haptics/texture/persistent_textures.h"
#include "haptics/tick/stepped_hand.h"
#include "workbench/commands/touch_path.h"
#include "workbench/commands/touch_sculpt.h"
#include "workbench/model/model.h"
#include "workbench/options/commands.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <vector>

namespace touchstone {

struct OfflineTick {
    uint64_t number = 0;
    double time = 0.0, dt = 0.0; ///< s
    DeviceSample sample;
    StageTrace trace;
    HapticOutput output;
    uint32_t poses = 0; ///< WorldState::poseHash
    uint32_t found = 0; ///< WorldState::foundContacts
    int64_t stepNs = 0;
    Similarity touched;  ///< workspaceFromObject of the touched object
    double gap = 0.0;    ///< m, of the proxy; in contact, if a report was requested
    uint32_t scene = 0;  ///< its number in a recording
    double impact = 0.0; ///< N s, of bodies that met
    HapticSettings settings;
    std::vector<BrushStroke> strokes;
};

/// State of an offline run.
class OfflineTouch {
  public:
    /// Both outlive it.
    OfflineTouch(const Model& model, const TouchOptions& options);

    void step(const PlannedTick& planned, OfflineTick& tick);
    /// Between two ticks: the same objects, some of which have been sculpted. The scene outlives it.
    void take(const HapticScene& reshaped, std::span<const int> sculpted);
    [[nodiscard]] bool moving() const { return touch_.world.moving(); }
    /// Between two steps at which the triangles near the hand were dropped.
    [[nodiscard]] TouchCheckpoint checkpoint();
    /// Before the first step: the state of the bodies; empty where there are none.
    [[nodiscard]] std::vector<std::byte> bodies() const { return touch_.world.bodyState(); }
    /// After the last step.
    [[nodiscard]] ObjectMotions objects() const { return touch_.world.poses(); }
    [[nodiscard]] const HapticScene& scene() const { return touch_.world.touched(*model_.haptic); }
    [[nodiscard]] const Plant& plant() const { return yielding_.plant(); }
    /// Null: the scene has none.
    [[nodiscard]] const PersistentTextures* textures() const { return touch_.world.textures().get(); }

  private:
    void operate();

    const Model& model_;
    HapticSettings settings_;
    SteppedHand touch_;
    body::JointSettings controls_;
    std::vector<body::Pose> poses_;                                  // of `operate`
    double previousTime_ = std::numeric_limits<double>::quiet_NaN(); // s, of the last step
    ToldHand path_;                                                  // the path's place in the next tick
    HandImpedance yielding_;                                         // in the closed loop
    Device& hand_;
};

/// `--record`: the state before the first tick, then every tick.
class OfflineRecorder {
  public:
    static constexpr uint32_t kScene = 1;

    OfflineRecorder(const TouchOptions& options, const Model& model);

    void add(const OfflineTick& tick, const TouchCheckpoint& first, const std::vector<std::byte>& bodies);
    /// The scene that the journal makes before `tick`, with the hand's state there. Returns its number.
    uint32_t sculpted(TouchSculpt& sculpt, uint64_t tick, TouchCheckpoint state);
    void flush() { writer_.flush(); }
    void finish() { writer_.finish(); }

  private:
    RecordingWriter writer_;
    struct Edit {
        uint64_t tick = 0; // its first
        uint64_t hash = 0;
        size_t entries = 0; // of the journal
        TouchCheckpoint state;
    };
    SceneIdentity identity_;
    std::shared_ptr<PersistentTextures> textures_; // before the next tick
    std::vector<SculptEntry> journal_;
    std::map<uint32_t, Edit> edits_; // by the scene's number
};

} // namespace touchstone

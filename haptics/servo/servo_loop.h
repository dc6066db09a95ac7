#pragma once
// The haptic thread: absolute deadlines, read - step - write - publish, nothing else (docs/architecture.md,
// Threads).

#include "engine/exchange/handover.h"
#include "engine/exchange/record_ring.h"
#include "engine/exchange/triple_buffer.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/servo/force_switch.h"
#include "haptics/servo/realtime_thread.h"
#include "haptics/servo/tool_path.h"
#include "haptics/state/touch_checkpoint.h"
#include "haptics/tick/haptic_step.h"
#include "haptics/tick/pad_step.h"
#include "haptics/world/driven_objects.h"
#include "haptics/world/world_state.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace touchstone {

/// The servo's record of one tick of one hand; streamed to the owner thread. Of the records of one tick that
/// of hand 0 is the last.
struct TickRecord {
    uint64_t tick = 0;         ///< number of the deadline; missed deadlines leave gaps
    uint32_t hand = 0;         ///< index of its DevicePort
    uint64_t step = 0;         ///< steps made before this one: a gap means dropped records
    double time = 0.0;         ///< s since the loop started, of the deadline
    double dt = 0.0;           ///< s, input of the step
    int32_t wakeLatencyNs = 0; ///< wake-up after the deadline; saturated
    int32_t stepNs = 0;        ///< time of the whole step, of all hands
    /// By Stage, parts of `stepNs`; zeros unless ServoConfig::stageTimes. Each is the time between two
    /// readings of the clock and includes one reading.
    std::array<int32_t, kStageCount> stageNs{};
    bool missed = false;     ///< the step ended after the next deadline
    bool late = false;       ///< input of the step: the preceding one was late
    bool checkpoint = false; ///< a TouchCheckpoint was taken before it (ServoLoop::popCheckpoint)
    bool whole = false;      ///< with the state of all that moves: a replay can begin here
    bool keptState = false;  ///< that of bodies is among it (ServoLoop::popBodyState)
    uint32_t settings = 0;   ///< number for ServoLoop::settingsOf
    /// Number that ServoLoop::offerScene returned, or that of a scene with other fields; 0: none, no step.
    uint32_t scene = 0;
    uint32_t root = 0;      ///< number that ServoLoop::offerScene returned for the scene that was reshaped
    uint32_t tool = 0;      ///< number for ServoLoop::toolOf
    uint32_t editDelay = 0; ///< ticks since the oldest edit that is first felt in this one; 0: none is
    uint32_t poses = 0;     ///< WorldState::poseHash; 0: nothing moves
    uint32_t found = 0;     ///< WorldState::foundContacts
    DeviceSample sample;    ///< as read; not valid where it is older than its limits allow
    StageTrace trace;
    HapticOutput output;
    PadTick pad; ///< of its contact location display
};

struct ServoConfig {
    double rateHz = 1000.0; ///< kMinServoRate..kMaxServoRate
    size_t ringCapacity = 1 << 14;
    bool wantRealtime = true;       ///< false: request nothing from the system (tests, sanitizers)
    double checkpointSeconds = 1.0; ///< from one TouchCheckpoint to the next
    bool stageTimes = false;        ///< TickRecord::stageNs; some 200 ns a tick
    double longestAside = 0.25;     ///< s: an edited scene waits for its vertices of the preceding tick
};

inline constexpr double kMinServoRate = 100.0;  ///< Hz; below it a stiff wall can no longer be stable
inline constexpr double kMaxServoRate = 4000.0; ///< Hz; above it wake-up latency is no longer small

/// Reads one sample and takes one command; all are called on the servo thread and must not block, allocate
/// or throw. Plain functions, so that haptics links no device.
struct DevicePort {
    void* context = nullptr;
    /// With the limits of the device that will get this tick's command (DeviceSample::limits).
    DeviceSample (*sample)(void* context, double time) noexcept = nullptr;
    void (*apply)(void* context, const DeviceCommand& command) noexcept = nullptr;
    /// Called before each sample; may be null.
    void (*feel)(void* context, const TouchFeedback& felt) noexcept = nullptr;
    /// The contact location display that the device has now; both may be null. Called before `apply`.
    PadLimits (*pad)(void* context) noexcept = nullptr;
    void (*applyPad)(void* context, const PadCommand& command) noexcept = nullptr;
};

/// Effect of a new scene on the present touch.
enum class SceneSwap : uint8_t {
    Anew,         ///< another world: touch begins again, and its force fades in
    SameGeometry, ///< the scene offered last, with other materials (withMaterials) or with more hidden
                  ///< objects (partOf): touch continues
    OtherPart,    ///< another part of that scene (partOf): touch continues where nothing that comes to be
                  ///< felt meets or encloses the hand (takeUpPart), as do bodies and persistent textures; a
                  ///< scene with soft bodies begins anew
};

/// A scene whose fields were edited, from the thread that edits.
struct ReshapedScene {
    std::shared_ptr<const HapticScene> scene;
    ScenePtr source;             ///< as ServoLoop::offerScene's
    uint32_t number = 0;         ///< ServoLoop::nextSceneNumber
    uint32_t root = 0;           ///< the owner's scene that it is an edit of; ignored beside any other
    std::vector<int> reshaped{}; ///< HapticScene::objects whose fields differ from those of the root
    uint64_t oldestEdit = 0;     ///< tick of the first edit that no scene before it has; 0: no hand made one
};

/// The owner thread constructs, starts and stops; every other function states its thread.
class ServoLoop {
  public:
    /// One port per hand. Throws Error if the rate is outside kMinServoRate..kMaxServoRate, there are not
    /// 1..kMaxHands ports, or one is incomplete.
    explicit ServoLoop(std::vector<DevicePort> ports, const ServoConfig& config = {});
    explicit ServoLoop(DevicePort port, const ServoConfig& config = {})
        : ServoLoop(std::vector<DevicePort>{port}, config) {}
    ~ServoLoop();
    ServoLoop(const ServoLoop&) = delete;
    ServoLoop& operator=(const ServoLoop&) = delete;

    /// Returns once the thread has its scheduling; no-op while running. Ticks are counted from 0 again:
    /// records of the last run should have been popped, since checkpoints and states are found by their tick.
    void start();
    void stop(); ///< joins; the last command sent is zero. May be restarted: time and ticks start from 0

    /// Makes tick `number` at once on the calling thread, without a clock: the same code, deterministic. Not
    /// while the servo thread runs. Allocates in the first call. The caller enters the float mode
    /// (engine/core/float_mode.h). `number` must grow. Returns the record of hand 0.
    TickRecord step(uint64_t number);

    /// Owner thread. Swapped in at a tick boundary; the owner frees the old scene. `source` is the scene it
    /// was compiled from, whose animation moves the objects; null: nothing moves. Returns the number by which
    /// TickRecord::scene names it. A null scene: nothing can be touched; the force of the previous scene goes
    /// to zero as fast as its device's limits allow, which the records do not contain. With SameGeometry the
    /// present touch continues: the force changes to that of the new materials, within the limits of force
    /// and slew and without fading, as when a setting changes. `settings`: as setSettings, but from the
    /// scene's first tick on, so that no tick has the one without the other. Null: the present ones.
    /// `driven`: objects that the caller moves; the same ones as long as the geometry stays.
    uint32_t offerScene(std::shared_ptr<const HapticScene> scene, ScenePtr source = nullptr,
                        SceneSwap swap = SceneSwap::Anew, const HapticSettings* settings = nullptr,
                        std::shared_ptr<DrivenObjects> driven = nullptr);
    /// The same for a scene that was sculpted, such as one with other materials: `scene` has the numbers of
    /// an edited scene and of its root, both new.
    void offerSculpted(ReshapedScene scene, SceneSwap swap);
    void setSettings(const HapticSettings& settings);
    /// Owner thread: in every hand, from the next tick on. It reaches the records under a number of its own.
    void setTool(const LiveTool& tool);
    /// Owner thread, as settingsOf.
    [[nodiscard]] const LiveTool& toolOf(uint32_t number) const;

    // Of one thread that edits fields:
    /// The oldest entry that the hands made and that was not popped.
    bool popEdit(SculptEntry& entry) { return edits_.pop(entry); }
    /// Unique among the scenes of both threads.
    [[nodiscard]] uint32_t nextSceneNumber() {
        return offeredScenes_.fetch_add(1, std::memory_order_relaxed) + 1;
    }
    /// Swapped in at a tick boundary; touch goes on.
    void offerEdited(ReshapedScene scene);
    /// Frees the scene that the servo has released.
    void collectEdited() { edited_.collect(); }
    /// Any thread: a sculpted scene waits to be adopted.
    [[nodiscard]] bool editedPending() const noexcept { return edited_.pending(); }
    [[nodiscard]] uint64_t droppedEdits() const {
        return edits_.dropped();
    } ///< lost to a full ring; any thread
    /// Any thread: switches the force off. While it is off a tick has the settings with forceEnabled off,
    /// under a number of their own.
    [[nodiscard]] ForceSwitch& forceSwitch() { return forceSwitch_; }
    /// Owner thread: the settings for TickRecord::settings of the record popped last, or of a later one.
    [[nodiscard]] const HapticSettings& settingsOf(uint32_t number) const;
    /// Owner thread: requests a checkpoint in the next tick, wherever the last one was.
    void requestCheckpoint() { checkpointWanted_.store(true, std::memory_order_relaxed); }

    /// Owner thread: newest tick of hand 0. Also frees the scene that the servo has released.
    bool updateSnapshot() {
        scene_.collect();
        return snapshot_.update();
    }
    [[nodiscard]] const TickRecord& snapshot() const { return snapshot_.value(); }
    /// Owner thread: every tick in order, with one record per hand.
    bool popRecord(TickRecord& record);
    /// Owner thread: every checkpoint in order. The checkpoint of a record is available when the record is,
    /// unless earlier ones were not popped (TouchCheckpoint::tick and `hand` identify it).
    bool popCheckpoint(TouchCheckpoint& checkpoint) { return checkpoints_.pop(checkpoint); }
    /// Owner thread: the next state of the scene's bodies that was kept at a checkpoint, in order.
    bool popBodyState(uint64_t& tick, std::vector<std::byte>& bytes);
    /// Owner thread: the persistent textures of a scene offered under this number, whose strokes can be
    /// popped (TextureCopy); null: it has none, or records of later scenes have been popped.
    [[nodiscard]] std::shared_ptr<PersistentTextures> texturesOf(uint32_t scene) const;
    /// Owner thread: what a caller moves in the scene of a record, before its tick; null: nothing, or nothing
    /// that a recording needs (DrivenObjects::before).
    [[nodiscard]] const DrivenState* drivenBefore(const TickRecord& record) const;
    /// Owner thread: callers may move objects of the root scene `root`.
    [[nodiscard]] bool drives(uint32_t root) const;
    /// Owner thread: where the bodies of the newest scene are; null: it has none.
    [[nodiscard]] const body::BodyPoses* bodyPoses();
    /// Owner thread: the soft bodies of the newest scene, whose publication is for the eye; null: it has
    /// none.
    [[nodiscard]] SoftStates* soft() const { return newest_.soft.get(); }
    /// Any thread: N s, BodyWorld::impact of the newest tick.
    [[nodiscard]] const std::atomic<double>& impact() const { return impact_; }
    /// Owner thread: the newest dents of each hand, for the eye.
    [[nodiscard]] const HandDents& dents() {
        dents_.update();
        return dents_.value();
    }
    [[nodiscard]] size_t hands() const { return ports_.size(); }

    struct Counters {
        uint64_t ticks = 0;          ///< steps made
        uint64_t missed = 0;         ///< steps that ended after the next deadline
        uint64_t skipped = 0;        ///< deadlines that passed during a late step: ticks never come in bursts
        uint64_t droppedRecords = 0; ///< ticks whose record was lost to a full ring
    };
    [[nodiscard]] Counters counters() const;          ///< any thread
    [[nodiscard]] ServoScheduling scheduling() const; ///< after start
    /// CLOCK_MONOTONIC, ns, at which the time of the ticks is 0; 0: never started. Any thread.
    [[nodiscard]] int64_t startedNs() const { return startedNs_.load(std::memory_order_relaxed); }
    [[nodiscard]] double rateHz() const { return config_.rateHz; }

  private:
    struct NumberedSettings {
        uint32_t number = 0;
        HapticSettings settings, withoutForce{.forceEnabled = false};
    };
    /// A scene with the state that only the servo changes in it.
    struct Offer {
        std::shared_ptr<const HapticScene> scene;
        mutable WorldState world; // servo thread once adopted
        uint32_t number = 0;
        // Equal numbers: equal geometry, but for the fields of `reshaped`. 0: that of the root, an edited
        // one.
        uint32_t geometry = 0;
        uint32_t root = 0;
        std::vector<int> reshaped{};
        uint64_t oldestEdit = 0;
        NumberedSettings settings{}; // that came with it, until newer ones come
        uint32_t part = 0;           // of the root: equal numbers, the same part of the scene
        // With SceneSwap::OtherPart what was offered before, by its number, which may be what is felt.
        uint32_t before = 0;
        std::shared_ptr<const HapticScene> partBefore{};
    };
    struct NumberedTool {
        uint32_t number = 0;
        LiveTool tool;
    };
    /// Bit of a settings number: with the force off.
    static constexpr uint32_t kWithoutForce = 1u << 31;
    struct Touch; // the loop's state from tick to tick

    void run() noexcept;
    static void adopt(Touch& touch, const Offer* offer) noexcept;
    [[nodiscard]] Offer offerOf(std::shared_ptr<const HapticScene> scene, WorldState world, uint32_t number,
                                SceneSwap swap);
    void holdTextures(uint32_t number, const WorldState& world);
    void offerWorld(std::shared_ptr<const Offer> offer);
    void setNewest(const WorldState& world);
    [[nodiscard]] CarriedOver newest();
    void prepare(Touch& touch) noexcept;
    void takeCheckpoints(Touch& touch, bool whole) noexcept;
    const NumberedSettings& number(const HapticSettings& settings);
    void showLocation(Touch& touch, size_t hand, double dt) noexcept;
    void sampleHands(Touch& touch, const TickRecord& record) noexcept;
    void tick(Touch& touch, uint64_t number, double dt) noexcept;
    void publishDents(const Touch& touch) noexcept;
    void sculpt(Touch& touch, const TickInput& input, ObjectMotions poses) noexcept;
    void publish(Touch& touch) noexcept;

    std::vector<DevicePort> ports_;
    ServoConfig config_;
    TripleBuffer<NumberedSettings> settings_;
    TripleBuffer<TickRecord> snapshot_;
    RecordRing<TickRecord> records_;
    ForceSwitch forceSwitch_;
    RecordRing<TouchCheckpoint> checkpoints_;
    std::atomic<bool> checkpointWanted_{false};
    Handover<Offer> scene_, edited_;
    TripleBuffer<NumberedTool> tools_;
    RecordRing<SculptEntry> edits_{4096};
    std::atomic<double> impact_{0.0};
    TripleBuffer<HandDents> dents_; // written where the scene gives way
    bool dented_ = false;           // the servo's: some were written
    std::atomic<uint32_t> offeredScenes_{0};
    // Owner thread:
    std::deque<NumberedSettings> offeredSettings_{NumberedSettings{}}; // that a record may still name
    std::deque<NumberedTool> offeredTools_{NumberedTool{}};
    uint32_t offeredGeometry_ = 0, offeredPart_ = 0, offeredLast_ = 0;
    std::shared_ptr<const HapticScene> lastScene_; // of offeredLast_
    std::shared_ptr<const Offer> waiting_;         // the scene that was offered before `start`
    bool findsApart_ = false; // the servo has a thread: contacts of bodies are found apart
    std::deque<std::pair<uint32_t, std::shared_ptr<PersistentTextures>>> textures_; // by scene offered
    std::deque<std::pair<uint32_t, std::shared_ptr<DrivenObjects>>> driven_;        // the same
    std::mutex newestMutex_; // the owner's writing of newest_, and reading by the thread that edits
    CarriedOver newest_;     // of the scene offered last; the servo's but for publications
    std::atomic<bool> stopping_{false};
    std::atomic<uint64_t> ticks_{0}, missed_{0}, skipped_{0};
    ServoScheduling scheduling_;
    std::atomic<bool> scheduled_{false};
    std::atomic<int64_t> startedNs_{0};
    std::thread thread_;
    std::unique_ptr<Touch> stepped_; // of `step`
    uint64_t lastStepped_ = 0;
};

} // namespace touchstone

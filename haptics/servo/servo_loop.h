#pragma once
// The haptic thread: absolute deadlines, read - step - write - publish, nothing else (docs/architecture.md,
// Threads).

#include "engine/exchange/handover.h"
#include "engine/exchange/record_ring.h"
#include "engine/exchange/triple_buffer.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/scene/moving_objects.h"
#include "haptics/servo/force_switch.h"
#include "haptics/servo/realtime_thread.h"
#include "haptics/state/touch_checkpoint.h"
#include "haptics/tick/haptic_step.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <thread>

namespace touchstone {

/// One tick as the servo lived it; streamed to the other side.
struct TickRecord {
    uint64_t tick = 0;         ///< number of the deadline: skips those that were slept through
    uint64_t step = 0;         ///< steps made before this one: where it jumps, records were dropped
    double time = 0.0;         ///< s since the loop started, of the deadline
    double dt = 0.0;           ///< s, that the step was told
    int32_t wakeLatencyNs = 0; ///< wake-up against the deadline; what does not fit is saturated
    int32_t stepNs = 0;        ///< time of the whole step
    /// By Stage, of `stepNs`; zeros unless ServoConfig::stageTimes. What lies between two readings of the
    /// clock, one of which is in each.
    std::array<int32_t, kStageCount> stageNs{};
    bool missed = false;     ///< the step ended after the next deadline
    bool late = false;       ///< what the step was told of the one before
    bool checkpoint = false; ///< a TouchCheckpoint was taken before it (ServoLoop::popCheckpoint)
    uint32_t settings = 0;   ///< which: ServoLoop::settingsOf
    uint32_t scene = 0;      ///< which: what ServoLoop::offerScene returned; 0: none, and no step
    DeviceSample sample;     ///< device 0, as it was read; not valid where it is older than the scene allows
    StageTrace trace;
    HapticOutput output; ///< device 0
};

struct ServoConfig {
    double rateHz = 1000.0; ///< kMinServoRate..kMaxServoRate
    size_t ringCapacity = 1 << 14;
    bool wantRealtime = true;       ///< false: ask the system for nothing (tests, sanitizers)
    double checkpointSeconds = 1.0; ///< from one TouchCheckpoint to the next
    bool stageTimes = false;        ///< TickRecord::stageNs; some 200 ns a tick
};

inline constexpr double kMinServoRate = 100.0;  ///< Hz; below it a stiff wall can no longer be stable
inline constexpr double kMaxServoRate = 4000.0; ///< Hz; above it wake-up latency is no longer small

/// Reads one sample and takes one command; all are called on the servo thread and must not block, allocate
/// or throw. Plain functions, so that haptics links no device.
struct DevicePort {
    void* context = nullptr;
    DeviceSample (*sample)(void* context, double time) noexcept = nullptr;
    void (*apply)(void* context, const DeviceCommand& command) noexcept = nullptr;
    /// Before each sample; may be null.
    void (*feel)(void* context, const TouchFeedback& felt) noexcept = nullptr;
};

/// What a new scene is to the touch that goes on.
enum class SceneSwap : uint8_t {
    Anew,         ///< another world: touch begins anew, and its force fades in
    SameGeometry, ///< the scene offered last, with other materials (withMaterials): touch goes on
};

/// Owner thread constructs, starts and stops; everything else says its thread.
class ServoLoop {
  public:
    /// Throws Error if the rate is outside kMinServoRate..kMaxServoRate or the port is incomplete.
    explicit ServoLoop(DevicePort port, const ServoConfig& config = {});
    ~ServoLoop();
    ServoLoop(const ServoLoop&) = delete;
    ServoLoop& operator=(const ServoLoop&) = delete;

    void start(); ///< returns once the thread has its scheduling; no-op while running
    void stop(); ///< joins; the last command sent is zero. May be started again: time and ticks go on from 0.

    /// Makes tick `number` at once on the calling thread, without a clock: the same code, deterministic. Not
    /// while it runs. Allocates in the first call. The caller enters the float mode
    /// (engine/core/float_mode.h). `number` grows.
    TickRecord step(uint64_t number);

    /// Owner thread. Swapped in at a tick boundary; the old scene is freed by the owner.
    /// `source` is the scene it was compiled from, whose animation moves the objects; null: nothing moves.
    /// Returns the number by which TickRecord::scene names it. Null: nothing is touched any more; the force
    /// of the scene before goes to zero as fast as its limits allow, of which the records say nothing. With
    /// SameGeometry the hand goes on touching what it touches: the force goes over to what it is with the new
    /// materials, within the limits of force and slew and without fading, as when a setting changes.
    uint32_t offerScene(std::shared_ptr<const HapticScene> scene, ScenePtr source = nullptr,
                        SceneSwap swap = SceneSwap::Anew);
    void setSettings(const HapticSettings& settings);
    /// Takes the force away from any thread. While it is off a tick has the settings with forceEnabled off,
    /// under a number of their own.
    [[nodiscard]] ForceSwitch& forceSwitch() { return forceSwitch_; }
    /// Owner thread: what TickRecord::settings of the record popped last, or of a later one, stands for.
    [[nodiscard]] const HapticSettings& settingsOf(uint32_t number) const;
    /// Owner thread: the next tick takes one, wherever the last one was.
    void requestCheckpoint() { checkpointWanted_.store(true, std::memory_order_relaxed); }

    /// Owner thread: newest tick. Also frees the scene that the servo let go.
    bool updateSnapshot() {
        scene_.collect();
        return snapshot_.update();
    }
    [[nodiscard]] const TickRecord& snapshot() const { return snapshot_.value(); }
    /// Owner thread: every tick in order.
    bool popRecord(TickRecord& record);
    /// Owner thread: every checkpoint in order. For a record that has one it is there when the record is,
    /// unless nobody popped the ones before (TouchCheckpoint::tick tells which it is).
    bool popCheckpoint(TouchCheckpoint& checkpoint) { return checkpoints_.pop(checkpoint); }

    struct Counters {
        uint64_t ticks = 0;          ///< steps made
        uint64_t missed = 0;         ///< steps that ended after the next deadline
        uint64_t skipped = 0;        ///< deadlines that passed meanwhile and got no step: ticks never bunch
        uint64_t droppedRecords = 0; ///< ticks whose record found the ring full
    };
    [[nodiscard]] Counters counters() const;          ///< any thread
    [[nodiscard]] ServoScheduling scheduling() const; ///< after start
    /// CLOCK_MONOTONIC, ns, at which the time of the ticks is 0; 0: never started. Any thread.
    [[nodiscard]] int64_t startedNs() const { return startedNs_.load(std::memory_order_relaxed); }
    [[nodiscard]] double rateHz() const { return config_.rateHz; }

  private:
    /// A scene with what the servo alone changes in it.
    struct Offer {
        std::shared_ptr<const HapticScene> scene;
        mutable MovingObjects moving; // servo thread once adopted
        uint32_t number = 0;
        uint32_t geometry = 0; // equal numbers: equal geometry
    };
    struct NumberedSettings {
        uint32_t number = 0;
        HapticSettings settings, withoutForce{.forceEnabled = false};
    };
    /// Bit of a settings' number: with the force taken away.
    static constexpr uint32_t kWithoutForce = 1u << 31;
    struct Touch; // what the loop carries from tick to tick

    void run() noexcept;
    static void adopt(Touch& touch, const Offer* offer) noexcept;
    void prepare(Touch& touch, TickRecord& record) noexcept;
    TickRecord tick(Touch& touch, uint64_t number, double dt) noexcept;

    DevicePort port_;
    ServoConfig config_;
    TripleBuffer<NumberedSettings> settings_;
    TripleBuffer<TickRecord> snapshot_;
    RecordRing<TickRecord> records_;
    ForceSwitch forceSwitch_;
    RecordRing<TouchCheckpoint> checkpoints_{64};
    std::atomic<bool> checkpointWanted_{false};
    Handover<Offer> scene_;
    // Owner thread:
    std::deque<NumberedSettings> offeredSettings_{NumberedSettings{}}; // that a record may name
    uint32_t offeredScenes_ = 0, offeredGeometry_ = 0;
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

#pragma once
// The haptic thread: absolute deadlines, read - step - write - publish, nothing else (DESIGN §8).

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "engine/exchange/handover.h"
#include "engine/exchange/record_ring.h"
#include "engine/exchange/triple_buffer.h"
#include "haptics/haptic_scene.h"
#include "haptics/haptic_step.h"

namespace touchstone {

/// One tick as the servo lived it; streamed to the other side.
struct TickRecord {
    uint64_t tick = 0;
    double time = 0.0;           ///< s since the loop started, of the deadline
    int32_t wakeLatencyNs = 0;   ///< wake-up against the deadline
    int32_t stepNs = 0;
    bool missed = false;         ///< the step ended after the next deadline
    HapticOutput output;         ///< device 0
};

/// What the servo was granted, for an honest report.
struct ServoScheduling {
    std::string policy;          ///< "SCHED_FIFO 80", "EEVDF slice 100 us", "normal"
    bool memoryLocked = false;
    int pinnedCpu = -1;
};

struct ServoConfig {
    double rateHz = 1000.0;      ///< 100..4000
    size_t ringCapacity = 1 << 14;
    bool wantRealtime = true;
};

/// Reads one sample and takes one command; both are called on the servo thread and must not block, allocate or
/// throw. Two plain functions, so that haptics links no device.
struct DevicePort {
    void* context = nullptr;
    DeviceSample (*sample)(void* context, double time) noexcept = nullptr;
    void (*apply)(void* context, const DeviceCommand& command) noexcept = nullptr;
};

/// Owner thread constructs, starts and stops; everything else says its thread.
class ServoLoop {
  public:
    explicit ServoLoop(DevicePort port, const ServoConfig& config = {});
    ~ServoLoop();
    ServoLoop(const ServoLoop&) = delete;
    ServoLoop& operator=(const ServoLoop&) = delete;

    void start();
    void stop(); ///< joins; the last command sent is zero

    /// Owner thread. Swapped in at a tick boundary; the old scene is freed by the owner.
    void offerScene(std::shared_ptr<const HapticScene> scene);
    void setSettings(const HapticSettings& settings) { settings_.write(settings); }

    /// Owner thread: newest tick.
    bool updateSnapshot() { return snapshot_.update(); }
    [[nodiscard]] const TickRecord& snapshot() const { return snapshot_.value(); }
    /// Owner thread: every tick in order.
    bool popRecord(TickRecord& record) { return records_.pop(record); }

    struct Counters {
        uint64_t ticks = 0, missed = 0, droppedRecords = 0;
    };
    [[nodiscard]] Counters counters() const;            ///< any thread
    [[nodiscard]] ServoScheduling scheduling() const;   ///< after start
    [[nodiscard]] double rateHz() const { return config_.rateHz; }

  private:
    void run() noexcept;

    DevicePort port_;
    ServoConfig config_;
    TripleBuffer<HapticSettings> settings_;
    TripleBuffer<TickRecord> snapshot_;
    RecordRing<TickRecord> records_;
    Handover<HapticScene> scene_;
    std::atomic<bool> stopping_{false};
    std::atomic<uint64_t> ticks_{0}, missed_{0};
    ServoScheduling scheduling_;
    std::atomic<bool> scheduled_{false};
    std::thread thread_;
};

} // namespace touchstone

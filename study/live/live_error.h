#pragma once
// The reference on its own thread, beside a running servo.

#include "engine/time/samples.h"
#include "study/live/reference_touch.h"

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace touchstone::study {

/// Errors over the last seconds. SI.
struct LiveErrorFigures {
    struct Pair {
        double p50 = 0.0, p99 = 0.0;
    };
    Pair position;                      ///< m
    Pair force;                         ///< N, of the magnitude
    Pair forceShare;                    ///< relative to the reference's
    Pair direction;                     ///< rad
    uint64_t inContact = 0;             ///< ticks in which both touch: the basis of the figures
    uint64_t lost = 0, invented = 0;    ///< ticks in which only the reference touches; only the servo
    double comparedShare = 0.0;         ///< fraction of the ticks that were compared; below one the reference
                                        ///< is too slow
    double stepNs = 0.0;                ///< mean time of a reference step
    uint64_t compared = 0, dropped = 0; ///< ticks since the start; dropped: the queue was full
};

/// All methods on one thread (the main thread); a worker does the comparison.
class LiveError {
  public:
    /// `seconds`: length of the window of the figures at `rateHz`; `capacity`: ticks that may wait.
    explicit LiveError(double rateHz, double seconds = 2.0, size_t capacity = 4096);
    ~LiveError();
    LiveError(const LiveError&) = delete;
    LiveError& operator=(const LiveError&) = delete;

    /// Call before the first record with this number: ServoLoop::offerScene's number and arguments.
    void sceneOffered(uint32_t number, std::shared_ptr<const HapticScene> scene, ScenePtr source);
    /// Every tick in order, with its settings; flush passes it on where there is room.
    void take(const TickRecord& record, const HapticSettings& settings);
    void flush();

    [[nodiscard]] LiveErrorFigures figures() const;
    /// Waits until all ticks passed on are compared (tests, offline).
    void drain();

  private:
    struct Tick {
        TickRecord record;
        HapticSettings settings;
    };
    struct OfferedScene {
        uint32_t number = 0;
        std::shared_ptr<const HapticScene> scene;
        ScenePtr source;
    };
    /// One tick of the latest `window_`.
    struct Entry {
        bool compared = false;
        TickError error;
    };

    void work();
    void compareBatch(const std::vector<Tick>& batch);
    void enterScene(uint32_t number);
    void add(const Entry& entry);
    void summarise();

    const size_t capacity_, window_;
    std::vector<Tick> batch_; // main thread

    mutable std::mutex mutex_;
    std::condition_variable wake_, idle_;
    std::vector<Tick> waiting_;
    std::deque<OfferedScene> scenes_;
    LiveErrorFigures figures_;
    uint64_t dropped_ = 0;
    bool stopping_ = false, busy_ = false;

    // The worker's:
    ReferenceTouch reference_;
    uint32_t scene_ = 0;
    uint64_t nextStep_ = 0;
    bool begun_ = false;
    std::deque<Entry> entries_;
    uint64_t compared_ = 0;
    Samples stepNs_;
    std::thread thread_;
};

} // namespace touchstone::study

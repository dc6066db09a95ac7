#pragma once
// Objects that a caller moves: where they are, where they are to go, and how fast.

#include "engine/core/checksum.h"
#include "engine/exchange/record_ring.h"
#include "engine/exchange/triple_buffer.h"
#include "engine/math/object_motion.h"
#include "engine/scene/scene.h"
#include "haptics/scene/haptic_scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace touchstone {

inline constexpr size_t kMostDriven = 16;
/// What a caller may ask for at most: no object comes faster towards a hand. m/s of its centre, and rad/s.
inline constexpr double kMostDriveSpeed = 0.5, kMostDriveTurn = 6.3;

/// An object on its way. Workspace.
struct DrivenPose {
    int32_t object = -1; ///< HapticScene::objects
    Similarity now, goal;
    double speed = 0.0; ///< m/s, of its centre
    double turn = 0.0;  ///< rad/s
};

/// All of them before the motion of one tick.
struct DrivenState {
    uint64_t tick = 0;
    uint32_t count = 0;
    std::array<DrivenPose, kMostDriven> objects{};
    [[nodiscard]] std::span<const DrivenPose> poses() const { return std::span(objects).first(count); }
};

/// Why the caller cannot move HapticScene::objects[object]; empty: it can.
[[nodiscard]] std::string drivenProblem(const Scene& source, const HapticScene& haptic, size_t object);

/// The pose after `dt` s: on the straight way and the shortest turn to the goal, no faster than allowed. At
/// most 10 ms of the way, so that a late tick moves nothing far.
[[nodiscard]] Similarity drivenAfter(const DrivenPose& pose, double dt) noexcept;

/// Goals from the owner thread, poses in the servo's ticks, states for recordings. Only scenes in which an
/// object was moved have one. Worlds of one geometry share it, one after the other (WorldState).
class DrivenObjects {
  public:
    // Owner thread.
    /// From the next tick on. `rest`: where the object stands if it was never moved. False: kMostDriven
    /// others are moved already.
    [[nodiscard]] bool drive(int object, const Similarity& rest, const Similarity& goal, double speed,
                             double turn) noexcept;
    /// All stop where they are.
    void halt() noexcept;
    /// Of the newest tick.
    [[nodiscard]] const DrivenState& newest() noexcept {
        shown_.update();
        return shown_.value();
    }
    /// The state before this tick, where it is one of those that recordings need: goals came, or a
    /// checkpoint was taken. Ticks in increasing order; null: none, or it was lost.
    [[nodiscard]] const DrivenState* before(uint64_t tick) noexcept;

    /// While no ticks are made: ticks are counted from 0 again.
    void forgetKept() noexcept;

    // Servo thread, or whoever makes the ticks. No allocation, no lock.
    /// A tick begins: takes new goals. `keep`: its state goes to `before`.
    void begin(uint64_t tick, double dt, bool keep) noexcept;
    /// In place of `begin`, from a recording.
    void restore(const DrivenState& state) noexcept { state_ = state; }
    void setStep(double dt) noexcept { dt_ = dt; }
    /// The motion of this tick; a second call in the same tick moves nothing. `first`: no object has a pose
    /// before.
    void advance(std::span<ObjectMotion> motions, bool first) noexcept;
    void addTo(Hash64& hash) const noexcept;

  private:
    struct Goal {
        int32_t object = -1;
        Similarity rest, goal;
        double speed = 0.0, turn = 0.0;
        bool halted = false;
    };
    struct Goals {
        uint32_t count = 0;
        std::array<Goal, kMostDriven> goals{};
    };
    Goals wanted_; // owner's
    TripleBuffer<Goals> goals_;
    TripleBuffer<DrivenState> shown_;
    RecordRing<DrivenState> kept_{2048};
    std::optional<DrivenState> popped_; // owner's: of this tick or a later one
    DrivenState state_;                 // of whoever makes the ticks
    double dt_ = 0.0;
};

} // namespace touchstone

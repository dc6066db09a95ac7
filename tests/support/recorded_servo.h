#pragma once
// A servo that is recorded: what a test does to it, what the device was sent, and whether a replay says the
// same.

#include "haptics/recording/replayer.h"
#include "haptics/recording/servo_recorder.h"
#include "haptics/servo/servo_loop.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace touchstone::test {

/// A scene of assets/scenes, fitted to the workspace.
struct TouchedScene {
    ScenePtr source;
    std::shared_ptr<const HapticScene> haptic;
    SceneIdentity identity;
};
[[nodiscard]] TouchedScene touchedScene(const std::string& file);

/// A square of 0.1 m, facing up, in the plane y = `height`, in the workspace.
[[nodiscard]] TouchedScene floorScene(float height);
/// The same of a material of its own, N/m.
[[nodiscard]] TouchedScene floorOf(float height, float stiffness);

/// The scene with all its materials changed, on the same geometry.
[[nodiscard]] TouchedScene withChanged(const TouchedScene& scene,
                                       const std::function<void(HapticMaterial&)>& change);

/// Circles over the doughnut's upper side, a millimetre deep, in the air now and then.
[[nodiscard]] glm::dvec3 overTheDoughnut(double time);

class RecordedServo {
  public:
    using Hand = std::function<DeviceSample(double time)>;

    /// The hands are called on the servo's thread, or on this one by steps(), and must not throw. One servo
    /// makes its ticks in one of both ways.
    explicit RecordedServo(Hand hand, const ServoConfig& config = kQuick)
        : RecordedServo(std::vector<Hand>{std::move(hand)}, config) {}
    explicit RecordedServo(std::vector<Hand> hands, const ServoConfig& config = kQuick);
    ~RecordedServo();

    /// Offered to the servo, named to the recorder.
    void offer(const TouchedScene& scene, SceneSwap swap = SceneSwap::Anew);
    /// Starts the servo where it does not run, and reads until `count` more ticks were made; calls `each`
    /// before each batch.
    void ticks(uint64_t count, const std::function<void()>& each = {});
    /// Makes them on this thread, without a clock: no tick is late, whatever else the machine does.
    void steps(uint64_t count);
    /// Makes them on the servo's thread and reads nothing.
    void ticksUnread(uint64_t count);
    void drain();
    /// Stops the servo and ends the recordings.
    void finish();

    /// Whatever a tick's input: each hand's command is finite, never above the limits of its device, and
    /// never changes faster than they allow; but a fault drops it to zero. Fails the test, naming the tick.
    void expectWithinLimits() const;
    [[nodiscard]] size_t countOf(TickFlag flag) const;
    [[nodiscard]] size_t inContact() const;

    static constexpr ServoConfig kQuick{.rateHz = 4000.0, .ringCapacity = 1 << 14, .wantRealtime = false};

  private:
    std::vector<Hand> hands_; // before the servo that uses them

  public:
    ServoLoop servo;
    ServoRecorder recorder;
    std::vector<TickRecord> records;  ///< of hand 0 that were read
    std::vector<TickRecord> others;   ///< of the other hands
    std::vector<TouchedScene> scenes; ///< offered, the first has number 1

  private:
    static void expectWithin(const std::vector<TickRecord>& records);
};

[[nodiscard]] DeviceSample at(const glm::dvec3& position);

/// Replays against the scenes that were offered, without their files.
[[nodiscard]] ReplayReport replayOf(const std::filesystem::path& file,
                                    const std::vector<TouchedScene>& scenes);

/// Fails the test where the replay is not equal throughout, or not everything was replayed.
void expectEqualReplay(const ReplayReport& report);

/// All items of a recording, and a recording of all items.
[[nodiscard]] std::vector<RecordedItem> itemsOf(const std::filesystem::path& file);
void writeItems(const std::filesystem::path& file, const std::vector<RecordedItem>& items);

} // namespace touchstone::test

#pragma once

#include "api/c/changed_materials.h"
#include "api/c/live_hand.h"
#include "api/c/tick_arrays.h"
#include "api/c/touched_scene.h"
#include "haptics/recording/servo_recorder.h"
#include "session/control_loop.h"
#include "session/session.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace touchstone::api {

/// What a ts_session names. Every function may be called from any thread and waits for the others, but for
/// `run`, which lets them in between two pumps.
class LiveSession final : public Object, private TickSubscriber {
  public:
    /// Throws Refused, and Error where the device cannot be opened.
    explicit LiveSession(const ts_session_options& options);
    ~LiveSession() override;

    void touch(std::shared_ptr<TouchedScene> scene);
    void set(std::string_view name, std::string_view value);
    void material(uint64_t material, std::string_view name, double value);
    [[nodiscard]] double materialNumber(uint64_t material, std::string_view name);
    /// Null: all objects that were moved stop where they are.
    void move(uint64_t object, const ts_pose* pose);
    [[nodiscard]] ts_pose pose(uint64_t object);
    void force(bool on);
    void render(bool byCaller);
    void goal(const ts_goal& goal);
    void record(const char* file);
    void start();
    void stop();
    [[nodiscard]] ts_state pump();
    using Callback = int (*)(void* context, const ts_state* state);
    void run(double seconds, double rate, Callback callback, void* context);
    [[nodiscard]] ts_state handState(size_t hand);
    [[nodiscard]] size_t takeKept(size_t hand, const TickArrays& ticks);
    void closed() override;

  private:
    void sceneOffered(const OfferedScene& scene) override;
    void take(const TickRecord& record, const HapticSettings& settings) override;
    void flush(double now) override;

    void requireOpen() const;
    void requireScene() const;
    void pumpSession();
    void pumpGoals();
    void offerAgain();
    void nameWholly();
    void makeSession();
    void enableControl();
    [[nodiscard]] ControlLoop& controlLoop();
    [[nodiscard]] LiveHand& hand(size_t number);
    [[nodiscard]] ts_state state();

    mutable std::recursive_mutex mutex_;
    double rate_;
    std::optional<ControlConfig> controlled_;
    std::vector<std::unique_ptr<LiveHand>> hands_;
    std::unique_ptr<ControlLoop> control_; // null: the servo commands the device
    std::unique_ptr<Session> session_;     // null: no scene yet
    std::optional<ServoRecorder> recorder_;
    std::shared_ptr<TouchedScene> scene_;
    std::optional<ChangedMaterials> changed_; // of scene_; none: as it says
    bool hashed_ = true;                      // the scene that is touched was offered with its feltHash
    std::shared_ptr<DrivenObjects> driven_;   // of scene_; null: no object was moved
    int unpumped_ = 0;                        // goals of objects since the last pump
    HapticSettings settings_;
    bool running_ = false, forceOn_ = true;
    std::atomic<bool> closed_{false};
    size_t keep_; // ticks of each hand
};

} // namespace touchstone::api

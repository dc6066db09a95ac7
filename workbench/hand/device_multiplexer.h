#pragma once

#include "devices/device/workspace_map.h"
#include "devices/link/linked_device.h"
#include "devices/mouse/mouse_device.h"
#include "devices/stroke/stroke_path.h"
#include "engine/exchange/handover.h"
#include "workbench/hand/glide.h"

#include <atomic>
#include <memory>

namespace touchstone {

/// The window's hand: the mouse, a simulated hand on the model's path, or a device. Switching glides from the
/// old position to the new one, so that nothing is hit at the speed of a jump. A device that is taken up
/// receives no force until the hand has reached it. Device and simulated hand have clutch and zoom
/// (WorkspaceMap); the mouse follows the pointer.
class DeviceMultiplexer final : public Device {
  public:
    /// s, duration of a switch.
    static constexpr double kGlideTime = kHandGlideTime;
    /// s, for the force to fade in after it.
    static constexpr double kCouplingTime = kHandCouplingTime;

    /// Owner thread.
    void simulate(bool simulated) noexcept { simulated_.store(simulated, std::memory_order_relaxed); }
    [[nodiscard]] bool simulated() const noexcept { return simulated_.load(std::memory_order_relaxed); }
    /// Before the servo starts: the simulated hand is ahead on its path by this share of its period.
    void lead(double share) noexcept { lead_ = share; }
    void offerPath(std::shared_ptr<const StrokePath> path) { path_.offer(std::move(path)); }
    /// Null: back to the mouse or the simulated hand. A released device receives zero force at once, before
    /// the servo notices.
    void hold(std::shared_ptr<LinkedDevice> device);
    /// Orientation of the user's view of the workspace: LinkedDevice::face.
    void face(const glm::dquat& deviceFromView);
    /// In addition to the device's own button. No effect on the mouse.
    void workspace(const WorkspaceWish& target) noexcept {
        zoom_.store(target.zoom, std::memory_order_relaxed);
        clutch_.store(target.clutch, std::memory_order_relaxed);
    }
    /// Maps the device's origin to the workspace's again, at once and without contact.
    void centre() noexcept { centres_.fetch_add(1, std::memory_order_relaxed); }
    /// Another model, or the same one rebuilt, is around the hand: the mouse is lifted off until its next
    /// goal, a stroke restarts. Call before that model is offered to the servo.
    void leave() noexcept {
        mouse_.release();
        leaves_.fetch_add(1, std::memory_order_release);
    }
    /// Frees what the servo no longer uses.
    void collect() { held_.collect(); }
    /// Owner thread: of the device in use.
    [[nodiscard]] PadLimits heldPad() const noexcept {
        return device_ != nullptr ? device_->pad() : PadLimits{};
    }
    [[nodiscard]] MouseDevice& mouse() { return mouse_; }

    [[nodiscard]] std::string name() const override;
    [[nodiscard]] DeviceLimits limits() const override;
    void feel(const TouchFeedback& felt) noexcept override;
    [[nodiscard]] DeviceSample sample(double time) noexcept override;
    void apply(const DeviceCommand& command) noexcept override;
    [[nodiscard]] PadLimits pad() const noexcept override {
        return driven_ != nullptr ? driven_->pad() : PadLimits{};
    }
    void applyPad(const PadCommand& command) noexcept override {
        if (driven_ != nullptr)
            driven_->applyPad(command);
    }

  private:
    struct Held {
        std::shared_ptr<LinkedDevice> device; // null: none
    };

    [[nodiscard]] WorkspaceWish target() const noexcept {
        return {zoom_.load(std::memory_order_relaxed), clutch_.load(std::memory_order_relaxed)};
    }
    void follow(const StrokePath* path, double time) noexcept;
    void begin(DeviceSample& sample) noexcept;
    void place(DeviceSample& sample, double time) noexcept;
    void couple(DeviceSample& sample, double time) noexcept;

    MouseDevice mouse_;
    std::shared_ptr<LinkedDevice> device_; // owner thread
    Handover<Held> held_;
    std::atomic<bool> simulated_{false};
    double lead_ = 0.0;
    Handover<StrokePath> path_;
    std::atomic<double> zoom_{1.0};
    std::atomic<bool> clutch_{false};
    std::atomic<uint32_t> centres_{0}, leaves_{0};
    // Servo thread:
    const void* followed_ = nullptr;           // the path or the device; null: the mouse
    LinkedDevice* driven_ = nullptr;           // in this tick
    glm::dvec3 lastHip_{0.0}, glideFrom_{0.0}; // workspace; device
    double glideStart_ = 0.0;
    WorkspaceMap map_;
    glm::dvec3 centre_{0.0}; // of the followed hand
    double lastTime_ = 0.0;
    double animation_ = 0.0;          // s, of the scene's animation in this tick
    uint32_t centred_ = 0, left_ = 0; // of centres_, leaves_
    bool changed_ = false;            // the hand's frame changed: this tick has no history
    bool started_ = false, gliding_ = false;
    bool begins_ = false; // the hand reaches its position: touch starts there
    bool away_ = false;   // the device is not at the hand's position, or the force is a remainder of the
                          // previous hand's
    double coupling_ = 1.0;
};

} // namespace touchstone

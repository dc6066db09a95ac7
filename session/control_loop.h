#pragma once
// The control loop apart from contact (docs/control.md), in real time: between a device and a servo that may
// be slower, or between a device and another program that renders contact.

#include "devices/device/device.h"
#include "engine/exchange/triple_buffer.h"
#include "haptics/control/proxy_spring.h"

#include <atomic>
#include <cstdint>
#include <thread>

namespace touchstone {

struct ControlConfig {
    double rateHz = 4000.0;
    /// W that the servo's contact may add to the spring; it is in time, and moves objects.
    double contactPower = 1.0;
    /// W that a caller's goals may.
    double goalPower = 0.0;
    PassivityMode passivity = PassivityMode::Off;
};

/// Whom the spring follows.
enum class GoalSource : uint8_t {
    Servo, ///< the force of each of its ticks, held by a spring of the device's recommended stiffness
    Caller ///< `hear`
};

/// To the servo this is its device. The servo's command F at a hand at x becomes the goal x + F / K, so that
/// whatever made F is the movement of a proxy [000 §7]; no force, no spring. A hand that the program moves by
/// what it feels (the mouse) cannot be behind it: `feel` ends here.
class ControlLoop final : public Device {
  public:
    /// `device` outlives it. Throws Error where the rate is not within 100..4000 Hz.
    ControlLoop(Device& device, const ControlConfig& config);
    ~ControlLoop() override;
    ControlLoop(const ControlLoop&) = delete;
    ControlLoop& operator=(const ControlLoop&) = delete;

    /// The newest state, workspace frame.
    struct State {
        uint64_t ticks = 0, missed = 0;
        bool holds = false;      ///< a goal pulls
        glm::dvec3 hip{0.0};     ///< m
        glm::dvec3 end{0.0};     ///< m, of the spring
        glm::dvec3 force{0.0};   ///< N, before safety
        glm::dvec3 command{0.0}; ///< N
        uint32_t flags = 0;      ///< TickFlag bits
        int source = 0;          ///< GoalSource that this tick followed
    };

    // Owner thread.
    void start();
    /// The last command is zero.
    void stop();
    /// Goals that were heard before are not followed; those from now on are, the first one, too.
    void follow(GoalSource source) noexcept;
    [[nodiscard]] GoalSource follows() const noexcept { return sourceOf(followed()); }
    /// N/m, the device's recommended one when this was made.
    [[nodiscard]] double stiffness() const noexcept { return stiffness_; }
    /// A goal of the caller's; what is wrong with it, or null.
    const char* hear(const ContactGoal& goal) noexcept;
    /// False: no force, whoever renders.
    void enableForce(bool on) noexcept { forceOn_.store(on, std::memory_order_relaxed); }
    [[nodiscard]] const State& state() noexcept;

    // Device: owner and servo thread.
    [[nodiscard]] std::string name() const override { return device_.name(); }
    [[nodiscard]] DeviceLimits limits() const override { return seen_.limits; }
    [[nodiscard]] DeviceSample sample(double time) noexcept override;
    void apply(const DeviceCommand& command) noexcept override;

  private:
    struct Taken {
        DeviceSample sample;
        long long atNs = 0; ///< monotonicNs; 0: never
        uint32_t begun = 0; ///< samples so far with which touch begins
    };
    /// What `follow` said last: its number, the source in the lowest bit.
    [[nodiscard]] uint32_t followed() const noexcept { return follow_.load(std::memory_order_relaxed); }
    [[nodiscard]] static GoalSource sourceOf(uint32_t followed) noexcept {
        return (followed & 1) != 0 ? GoalSource::Caller : GoalSource::Servo;
    }
    /// A goal of the caller's, and `followed` when it came.
    struct Heard {
        ContactGoal goal;
        uint32_t followed = 0;
    };
    void hearNewest(const DeviceSample& sample) noexcept;
    void run() noexcept;
    void tick(uint64_t number, double dt) noexcept;

    Device& device_;
    ControlConfig config_;
    double stiffness_;
    std::atomic<uint32_t> follow_{0};
    std::atomic<bool> forceOn_{true}, stopping_{false};
    std::atomic<uint64_t> missed_{0};
    TripleBuffer<Taken> taken_;           ///< to the servo
    TripleBuffer<ContactGoal> fromServo_; ///< to the loop
    TripleBuffer<Heard> fromCaller_;      ///< to the loop
    TripleBuffer<State> states_;          ///< to the owner
    // Servo thread:
    DeviceSample seen_;
    uint32_t begun_ = 0;
    // Loop's thread:
    ProxySpring spring_;
    uint32_t followed_ = 0;
    Taken now_;
    bool late_ = false; // the last tick ended more than a period late
    std::thread thread_;
};

} // namespace touchstone

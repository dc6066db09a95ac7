#pragma once
// A HID device: hidapi on its own thread, a mailbox to the servo.

#include "devices/hid/hid_list.h"
#include "devices/hid/hid_port.h"
#include "devices/hid/hid_protocol.h"
#include "devices/hid/rate_hand.h"
#include "devices/link/linked_device.h"

#include <condition_variable>
#include <memory>
#include <optional>
#include <span>
#include <thread>

namespace touchstone {

/// Identifies a device again after it was unplugged, at any port.
struct HidIdentity {
    int interfaceNumber = -1;
    std::string serial, productName;
};
[[nodiscard]] HidIdentity identityOf(const HidNode& node);

/// All that is known of a device before it is plugged in.
struct HidRecipe {
    std::string name;
    UsbMatch usb;
    std::string path; ///< preferred where several match; empty: any
    /// Of the node chosen or connected first. Once set, no other node matches, in particular no other board
    /// with the same ids.
    std::optional<HidIdentity> identity;
    DeviceLimits limits;
    PadLimits pad;
    std::unique_ptr<HidProtocol> protocol;
    std::optional<RateSettings> rate; ///< for devices with rate control
};

/// A 3Dconnexion device at this node.
[[nodiscard]] HidRecipe spaceMouseRecipe(const HidNode& node);
/// A device described by a file. `path`: the node, if one was named.
[[nodiscard]] HidRecipe recipeOf(const DeviceFile& file, const std::string& path = {});

/// The node that a recipe matches: by ids, interface, serial and identity, the preferred path first, none
/// that is in use. Null if there is none. Of a SpaceMouse with several nodes, the one with axes.
[[nodiscard]] const HidNode* findNode(const HidRecipe& recipe, std::span<const HidNode> nodes,
                                      const std::set<std::string>& inUse);

/// The device may be unplugged and plugged in again at any time; samples are invalid meanwhile. It receives
/// zero force when the servo stops, when the servo is silent for kServoSilence, and at the end.
class HidDevice final : public LinkedDevice {
  public:
    /// Starts the I/O thread; report() tells whether the device is present.
    explicit HidDevice(HidRecipe recipe);
    ~HidDevice() override;

    [[nodiscard]] std::string name() const override { return recipe_.name; }
    [[nodiscard]] DeviceLimits limits() const override { return recipe_.limits; }
    [[nodiscard]] PadLimits pad() const noexcept override { return recipe_.pad; }
    [[nodiscard]] DeviceSample sample(double time) noexcept override;
    void face(const glm::dquat& deviceFromView) override { deviceFromView_.write(deviceFromView); }

  private:
    // I/O thread
    void run();
    void connect();
    void exchange();
    void takeReports(std::span<uint8_t> buffer, int length, int64_t arrivedNs);
    void takeReport(std::span<const uint8_t> report, int64_t arrivedNs);
    void send(int64_t nowNs);
    void disconnect(const std::string& problem);
    void sayZero();
    bool waitStopping(double seconds);

    HidRecipe recipe_;
    HidPort port_;
    DeviceReading reading_;
    int64_t emptyNs_ = 0; ///< time when the queue of reports was last empty
    int64_t sentNs_ = 0;
    int failedSends_ = 0; ///< consecutive

    std::mutex mutex_;
    std::condition_variable wake_;
    bool stopping_ = false;
    std::atomic<bool> stop_{false};

    TripleBuffer<glm::dquat> deviceFromView_{glm::dquat(1.0, 0.0, 0.0, 0.0)};
    // Servo thread
    std::optional<RateHand> rateHand_;
    double lastTime_ = 0.0;
    bool moving_ = false;

    std::thread thread_;
};

} // namespace touchstone

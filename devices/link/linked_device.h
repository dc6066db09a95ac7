#pragma once
// Devices behind a link that may block, fail or deliver wrong data: a bus or a socket.

#include "devices/device/device.h"
#include "devices/link/device_mailbox.h"

#include <atomic>
#include <mutex>
#include <string>

namespace touchstone {

enum class LinkState : uint8_t {
    Searching, ///< absent (yet, or no longer); searched for twice a second
    Refused,   ///< present without permission; `problem` gives reason and remedy
    Connected
};

/// Packet counts and state of a link since the device was created.
struct LinkReport {
    LinkState state = LinkState::Searching;
    std::string problem;    ///< with its remedy; empty while connected
    std::string where;      ///< "/dev/hidraw0", "127.0.0.1:40512"; empty until the first connection
    uint64_t reports = 0;   ///< well formed, with a position of the hand
    uint64_t ignored = 0;   ///< well formed, without use (battery, a second client, …)
    uint64_t malformed = 0; ///< too short, too long, wrong checksum, non-finite numbers
    uint64_t repeated = 0;  ///< duplicate or out of order
    uint64_t lost = 0;      ///< gaps in the sequence numbers, if the protocol has them
    uint64_t sent = 0;      ///< commands
    uint64_t sendFailures = 0;
    uint64_t connects = 0;
    bool realtime = false; ///< the I/O thread got SCHED_FIFO
};

/// Report of an I/O thread. Counters may be read by any thread.
class LinkMonitor {
  public:
    using Counter = std::atomic<uint64_t>;
    Counter reports{0}, ignored{0}, malformed{0}, repeated{0}, lost{0}, sent{0}, sendFailures{0}, connects{0};
    std::atomic<bool> realtime{false};

    static void count(Counter& counter, uint64_t by = 1) noexcept {
        counter.fetch_add(by, std::memory_order_relaxed);
    }

    /// I/O thread. The lock is shared with the owner thread only, never with the servo.
    void connected(const std::string& where);
    void disconnected(LinkState state, const std::string& problem);

    [[nodiscard]] LinkReport report() const; ///< owner thread

  private:
    mutable std::mutex mutex_;
    LinkState state_ = LinkState::Searching;
    std::string problem_, where_;
};

/// A device with an I/O thread and a mailbox. sample and apply only touch the mailbox.
class LinkedDevice : public Device {
  public:
    [[nodiscard]] LinkReport report() const { return monitor_.report(); } ///< owner thread

    [[nodiscard]] DeviceSample sample(double) noexcept override {
        return sampleOf(mailbox_.reading(), steadyNs());
    }
    void apply(const DeviceCommand& command) noexcept override { mailbox_.give(command); }
    void applyPad(const PadCommand& command) noexcept override { mailbox_.show(command); }

    /// Owner thread: the device is no longer in use. It receives zero force at once, without waiting for
    /// kServoSilence after the servo's last order. New orders are held back.
    void letGo() noexcept { mailbox_.letGo(); }
    /// Owner thread: the device is in use again, with the orders that the servo gives from now on.
    void takeUp() noexcept { mailbox_.takeUp(); }

    /// Owner thread: orientation of the user's view of the workspace (view: x right, y up, z towards the
    /// viewer). A rate-controlled device moves the hand in the direction seen on the screen; a device that is
    /// moved stands on the desk and ignores it.
    virtual void face(const glm::dquat& deviceFromView) { (void)deviceFromView; }

  protected:
    DeviceMailbox mailbox_;
    LinkMonitor monitor_;
};

/// Requests SCHED_FIFO below the servo's priority, so that queued reports are read at once. False where
/// denied.
bool enterIoPriority() noexcept;

} // namespace touchstone

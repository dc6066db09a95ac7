#pragma once
// Devices at the other end of something that may block, break or lie: a bus or a socket.

#include "devices/device/device.h"
#include "devices/link/device_mailbox.h"

#include <atomic>
#include <mutex>
#include <string>

namespace touchstone {

enum class LinkState : uint8_t {
    Searching, ///< not there (yet, or no longer); looked for twice a second
    Refused,   ///< there, but may not be used; `problem` says why and what to do
    Connected
};

/// What came over a link and what became of it, since the device was made.
struct LinkReport {
    LinkState state = LinkState::Searching;
    std::string problem;    ///< with its remedy; empty while connected
    std::string where;      ///< "/dev/hidraw0", "127.0.0.1:40512"; empty until the first connection
    uint64_t reports = 0;   ///< well formed ones that carry the hand's place
    uint64_t ignored = 0;   ///< well formed, but of no use (battery, a second client, …)
    uint64_t malformed = 0; ///< too short, too long, wrong checksum, numbers that are none
    uint64_t repeated = 0;  ///< seen before, or overtaken by newer ones
    uint64_t lost = 0;      ///< gaps in the sequence numbers, where there are such numbers
    uint64_t sent = 0;      ///< commands
    uint64_t sendFailures = 0;
    uint64_t connects = 0;
    bool realtime = false; ///< the I/O thread got SCHED_FIFO
};

/// Where an I/O thread keeps its report. Counters may be read by any thread.
class LinkMonitor {
  public:
    using Counter = std::atomic<uint64_t>;
    Counter reports{0}, ignored{0}, malformed{0}, repeated{0}, lost{0}, sent{0}, sendFailures{0}, connects{0};
    std::atomic<bool> realtime{false};

    static void count(Counter& counter, uint64_t by = 1) noexcept {
        counter.fetch_add(by, std::memory_order_relaxed);
    }

    /// I/O thread. The lock is shared with the owner thread alone, never with the servo.
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

    /// Owner thread: nobody drives it any more. What it is told next is zero force, without waiting for the
    /// servo, whose last order would otherwise hold for kServoSilence. New ones are held.
    void letGo() noexcept { mailbox_.letGo(); }
    /// Owner thread: it is driven again, by what the servo says from now on.
    void takeUp() noexcept { mailbox_.takeUp(); }

    /// Owner thread: how the user looks at the workspace (view: x right, y up, z towards the viewer). What is
    /// pushed goes where it is pushed on the screen; what is moved stands on the desk and does not care.
    virtual void face(const glm::dquat& deviceFromView) { (void)deviceFromView; }

  protected:
    DeviceMailbox mailbox_;
    LinkMonitor monitor_;
};

/// Asks for SCHED_FIFO below the servo's, so that a waiting report is not left waiting. False where denied.
bool enterIoPriority() noexcept;

} // namespace touchstone

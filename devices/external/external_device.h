#pragma once
// A device implemented by another program: it sends positions and receives forces over UDP, on this machine
// only.

#include "devices/external/external_packet.h"
#include "devices/link/linked_device.h"

#include <atomic>
#include <thread>

namespace touchstone {

inline constexpr uint16_t kExternalPort = 47470;

/// Serves one client at a time: the first one with a well-formed packet, until it has been silent for
/// kClientSilence. Packets from others are counted as ignored. The client receives zero force when the servo
/// is silent for kServoSilence, and as the last packet.
class ExternalDevice final : public LinkedDevice {
  public:
    /// s; then the sample is invalid and another client may connect.
    static constexpr double kClientSilence = 1.0;

    /// Binds to 127.0.0.1, which is unreachable from other machines, and starts the I/O thread. Port 0: any
    /// free port. Throws Error when the port is taken.
    explicit ExternalDevice(uint16_t port = kExternalPort);
    ~ExternalDevice() override;
    ExternalDevice(const ExternalDevice&) = delete;
    ExternalDevice& operator=(const ExternalDevice&) = delete;

    [[nodiscard]] uint16_t port() const { return port_; }
    [[nodiscard]] std::string name() const override { return "external device"; }
    /// A desktop program has more timing jitter than a microcontroller.
    [[nodiscard]] DeviceLimits limits() const override {
        DeviceLimits limits;
        limits.staleAge = 0.05;
        return limits;
    }

    /// As its client declares.
    [[nodiscard]] PadLimits pad() const noexcept override {
        return {padReach_.load(std::memory_order_relaxed), padRate_.load(std::memory_order_relaxed)};
    }

  private:
    struct Client {
        uint32_t address = 0; ///< network byte order; 0: none
        uint16_t port = 0;
        bool operator==(const Client&) const = default;
    };

    // I/O thread
    void run();
    void receive();
    void take(std::span<const uint8_t> packet, const Client& from, int64_t arrivedNs);
    void declare(const PadPacket& packet, const Client& from);
    void welcome(const Client& client);
    void leave();
    void send(const ForceOrder& order, int64_t nowNs);

    uint16_t port_ = 0;
    int socket_ = -1;
    Client client_;
    uint32_t heard_ = 0, said_ = 0;
    int64_t heardNs_ = 0; ///< time of the client's last well-formed packet
    int64_t sentNs_ = 0;  ///< time of the last force sent
    int64_t emptyNs_ = 0; ///< time when the socket was last empty
    std::atomic<double> padReach_{0.0}, padRate_{0.0};
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

} // namespace touchstone

#pragma once
// One open HID node. The only file besides the list that knows hidapi.

#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <string>

struct hid_device_;

namespace touchstone {

/// One thread at a time.
class HidPort {
  public:
    HidPort() = default;
    ~HidPort() { close(); }
    HidPort(const HidPort&) = delete;
    HidPort& operator=(const HidPort&) = delete;

    /// Empty when it is open now, else what is wrong. A node that another port of this process has open is
    /// refused: two threads would take each other's reports.
    [[nodiscard]] std::string open(const std::string& path);
    void close() noexcept;
    [[nodiscard]] bool isOpen() const { return device_ != nullptr; }

    /// Bytes of the next report, 0 when none came within `timeoutMs`, -1 when the device is gone.
    [[nodiscard]] int read(std::span<uint8_t> report, int timeoutMs) noexcept;
    /// A report with its id first. May block for as long as the bus takes.
    [[nodiscard]] bool write(std::span<const uint8_t> report) noexcept;

    /// The nodes that ports of this process have open. Any thread.
    [[nodiscard]] static std::set<std::string> nodesInUse();

  private:
    hid_device_* device_ = nullptr;
    std::string path_;
};

} // namespace touchstone

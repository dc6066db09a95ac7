#pragma once
// One open HID node. Besides the list, the only file that uses hidapi.

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

    /// Empty on success, else the problem. A node that another port of this process has open is refused: the
    /// two threads would steal each other's reports.
    [[nodiscard]] std::string open(const std::string& path);
    void close() noexcept;
    [[nodiscard]] bool isOpen() const { return device_ != nullptr; }

    /// Length of the next report, 0 when none arrived within `timeoutMs`, -1 when the device is gone.
    [[nodiscard]] int read(std::span<uint8_t> report, int timeoutMs) noexcept;
    /// `report` starts with its id. May block for as long as the bus takes.
    [[nodiscard]] bool write(std::span<const uint8_t> report) noexcept;

    /// The nodes that this process has open. Any thread.
    [[nodiscard]] static std::set<std::string> nodesInUse();

  private:
    hid_device_* device_ = nullptr;
    std::string path_;
};

} // namespace touchstone

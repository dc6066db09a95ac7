#pragma once
// The protocol of each kind of HID device, between the pure parsers and the I/O thread.

#include "devices/hid/device_file.h"
#include "devices/hid/report_bytes.h"
#include "devices/link/device_mailbox.h"

#include <memory>

namespace touchstone {

inline constexpr size_t kMaxReportSize = 1 + 64;

/// Protocol state of one device. I/O thread only; no transport, no clock.
class HidProtocol {
  public:
    virtual ~HidProtocol() = default;
    /// Starts a new connection and discards the state of the last one. `reading`: what is known before any
    /// report.
    virtual void restart(DeviceReading& reading) = 0;
    /// Parses one report. On Reading, `reading` holds the state of the hand except its time. Adds the reports
    /// missing by sequence number to `lost`.
    [[nodiscard]] virtual ReportVerdict take(std::span<const uint8_t> report, DeviceReading& reading,
                                             uint64_t& lost) = 0;
    /// True if the last report stays valid during silence, as of a device that only reports changes.
    [[nodiscard]] virtual bool silenceHolds() const { return false; }
    /// True if the device accepts forces.
    [[nodiscard]] virtual bool driven() const { return true; }
    /// Writes the report that carries this order, its id first, and returns its length.
    [[nodiscard]] virtual size_t command(const ForceOrder& order,
                                         std::span<uint8_t, kMaxReportSize> report) = 0;
};

[[nodiscard]] std::unique_ptr<HidProtocol> makeSpaceMouseProtocol();
/// The protocol named by the file, with its arm.
[[nodiscard]] std::unique_ptr<HidProtocol> makeProtocol(const DeviceFile& file);

} // namespace touchstone

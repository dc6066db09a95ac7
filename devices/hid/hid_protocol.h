#pragma once
// What each kind of HID device says and wants to hear, between the pure parsers and the I/O thread.

#include "devices/hid/device_file.h"
#include "devices/hid/report_bytes.h"
#include "devices/link/device_mailbox.h"

#include <memory>

namespace touchstone {

inline constexpr size_t kMaxReportSize = 1 + 64;

/// One device's side of the conversation. I/O thread only; no transport, no clock.
class HidProtocol {
  public:
    virtual ~HidProtocol() = default;
    /// A new connection: what the last one said no longer holds. `reading` is what is known before any
    /// report.
    virtual void restart(DeviceReading& reading) = 0;
    /// One report. With Reading, `reading` holds what is now known of the hand, but for its time. Adds to
    /// `lost` what the sequence numbers say was.
    [[nodiscard]] virtual ReportVerdict take(std::span<const uint8_t> report, DeviceReading& reading,
                                             uint64_t& lost) = 0;
    /// Whether silence means that the last report still holds, as of a device that speaks only of changes.
    [[nodiscard]] virtual bool silenceHolds() const { return false; }
    /// Whether it takes forces.
    [[nodiscard]] virtual bool driven() const { return true; }
    /// Writes the report that gives this order, its id first, and returns its length.
    [[nodiscard]] virtual size_t command(const ForceOrder& order,
                                         std::span<uint8_t, kMaxReportSize> report) = 0;
};

[[nodiscard]] std::unique_ptr<HidProtocol> makeSpaceMouseProtocol();
/// The protocol that the file names, with its arm.
[[nodiscard]] std::unique_ptr<HidProtocol> makeProtocol(const DeviceFile& file);

} // namespace touchstone

#pragma once
// Polhem and WoodenHaptics (Forsslund Systems): encoder counts in, motor currents out. Pure; no transport.

#include "devices/hid/report_bytes.h"

#include <array>
#include <optional>

namespace touchstone {

inline constexpr size_t kWoodenReportSize = 14;      ///< in: seven int16
inline constexpr size_t kWoodenCommandSize = 1 + 14; ///< out: report id 0 and seven int16

struct WoodenReport {
    std::array<int16_t, 6> counts{}; ///< a, b, c of the arm, d, e, f of the gimbal; they wrap
    int16_t info = 0;                ///< 1: the device requests calibration
};

/// Parses exactly fourteen bytes; else nullopt.
[[nodiscard]] std::optional<WoodenReport> parseWoodenReport(std::span<const uint8_t> report);

/// The command that sends three motor currents, mA (command word 0, no arguments).
[[nodiscard]] std::array<uint8_t, kWoodenCommandSize>
woodenCommand(const std::array<int16_t, 3>& milliamperes);

/// Extends 16-bit counters beyond their range: between two reports an encoder turns by less than half of it.
class CountUnwrapper {
  public:
    /// The first counts are returned unchanged.
    std::array<double, 6> follow(const std::array<int16_t, 6>& counts);
    void restart() { started_ = false; }

  private:
    std::array<int16_t, 6> last_{};
    std::array<int64_t, 6> total_{};
    bool started_ = false;
};

} // namespace touchstone

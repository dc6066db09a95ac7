#include "devices/hid/woodenhaptics_report.h"

namespace touchstone {

std::optional<WoodenReport> parseWoodenReport(std::span<const uint8_t> report) {
    if (report.size() != kWoodenReportSize)
        return std::nullopt;
    WoodenReport parsed;
    for (size_t i = 0; i < parsed.counts.size(); ++i)
        parsed.counts[i] = readI16(report, 2 * i);
    parsed.info = readI16(report, 12);
    return parsed;
}

std::array<uint8_t, kWoodenCommandSize> woodenCommand(const std::array<int16_t, 3>& milliamperes) {
    std::array<uint8_t, kWoodenCommandSize> command{};
    for (size_t i = 0; i < milliamperes.size(); ++i)
        writeU16(command, 1 + 2 * i, static_cast<uint16_t>(milliamperes[i]));
    return command;
}

std::array<double, 6> CountUnwrapper::follow(const std::array<int16_t, 6>& counts) {
    std::array<double, 6> result{};
    for (size_t i = 0; i < counts.size(); ++i) {
        if (started_)
            total_[i] +=
                static_cast<int16_t>(static_cast<uint16_t>(counts[i]) - static_cast<uint16_t>(last_[i]));
        else
            total_[i] = counts[i];
        result[i] = static_cast<double>(total_[i]);
    }
    last_ = counts;
    started_ = true;
    return result;
}

} // namespace touchstone

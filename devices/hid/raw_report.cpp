#include "devices/hid/raw_report.h"

namespace touchstone {

namespace {

// Byte offsets; docs/devices.md has the same table.
constexpr size_t kKind = 2, kFlags = 3, kSequence = 4, kTime = 8, kAnswered = 12, kButtons = 16, kAxes = 20;
constexpr size_t kAnswers = 8, kValues = 12, kWatchdogMs = 36, kLocation = 40;
constexpr size_t kChecksum = 60;

constexpr std::array<uint32_t, 256> makeCrcTable() {
    std::array<uint32_t, 256> table{};
    for (uint32_t i = 0; i < table.size(); ++i) {
        uint32_t remainder = i;
        for (int bit = 0; bit < 8; ++bit)
            remainder = remainder >> 1 ^ ((remainder & 1) != 0 ? 0xEDB88320u : 0u);
        table[i] = remainder;
    }
    return table;
}
constexpr std::array<uint32_t, 256> kCrcTable = makeCrcTable();

bool wellFormed(std::span<const uint8_t> report) {
    return report.size() == kRawReportSize && report[0] == kRawMagic && report[1] == kRawVersion &&
           readU32(report, kChecksum) == crc32(report.first(kChecksum));
}

std::array<uint8_t, kRawReportSize> begun(uint8_t kind, uint32_t sequence) {
    std::array<uint8_t, kRawReportSize> report{};
    report[0] = kRawMagic;
    report[1] = kRawVersion;
    report[kKind] = kind;
    writeU32(report, kSequence, sequence);
    return report;
}

void seal(std::array<uint8_t, kRawReportSize>& report) {
    writeU32(report, kChecksum, crc32(std::span(report).first(kChecksum)));
}

} // namespace

uint32_t crc32(std::span<const uint8_t> bytes) {
    uint32_t remainder = 0xFFFFFFFFu;
    for (const uint8_t byte : bytes)
        remainder = remainder >> 8 ^ kCrcTable[(remainder ^ byte) & 0xFF];
    return ~remainder;
}

std::optional<RawState> parseRawState(std::span<const uint8_t> report) {
    if (!wellFormed(report) || report[kKind] != kRawState)
        return std::nullopt;
    RawState state{.flags = report[kFlags],
                   .sequence = readU32(report, kSequence),
                   .deviceTimeUs = readU32(report, kTime),
                   .answered = readU32(report, kAnswered),
                   .buttons = readU32(report, kButtons)};
    for (size_t i = 0; i < state.axes.size(); ++i)
        state.axes[i] = readI32(report, kAxes + 4 * i);
    return state;
}

std::optional<RawCommand> parseRawCommand(std::span<const uint8_t> report) {
    if (!wellFormed(report) || (report[kKind] != kRawForce && report[kKind] != kRawCurrent))
        return std::nullopt;
    RawCommand command{.kind = report[kKind],
                       .sequence = readU32(report, kSequence),
                       .answers = readU32(report, kAnswers),
                       .watchdogMs = readU16(report, kWatchdogMs)};
    for (size_t i = 0; i < command.values.size(); ++i)
        command.values[i] = readI32(report, kValues + 4 * i);
    for (size_t i = 0; i < command.location.size(); ++i)
        command.location[i] = readI32(report, kLocation + 4 * i);
    return command;
}

std::array<uint8_t, kRawReportSize> rawState(const RawState& state) {
    auto report = begun(kRawState, state.sequence);
    report[kFlags] = state.flags;
    writeU32(report, kTime, state.deviceTimeUs);
    writeU32(report, kAnswered, state.answered);
    writeU32(report, kButtons, state.buttons);
    for (size_t i = 0; i < state.axes.size(); ++i)
        writeU32(report, kAxes + 4 * i, static_cast<uint32_t>(state.axes[i]));
    seal(report);
    return report;
}

std::array<uint8_t, kRawReportSize> rawCommand(const RawCommand& command) {
    auto report = begun(command.kind, command.sequence);
    writeU32(report, kAnswers, command.answers);
    for (size_t i = 0; i < command.values.size(); ++i)
        writeU32(report, kValues + 4 * i, static_cast<uint32_t>(command.values[i]));
    writeU16(report, kWatchdogMs, command.watchdogMs);
    for (size_t i = 0; i < command.location.size(); ++i)
        writeU32(report, kLocation + 4 * i, static_cast<uint32_t>(command.location[i]));
    seal(report);
    return report;
}

} // namespace touchstone

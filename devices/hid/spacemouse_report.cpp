#include "devices/hid/spacemouse_report.h"

#include <algorithm>

namespace touchstone {

namespace {

constexpr uint8_t kTranslationReport = 1, kRotationReport = 2, kButtonsReport = 3;
constexpr size_t kThreeAxes = 1 + 3 * 2, kSixAxes = 1 + 6 * 2;

void readAxes(std::span<const uint8_t> report, std::span<int16_t> axes) {
    for (size_t i = 0; i < axes.size(); ++i)
        axes[i] = readI16(report, 1 + 2 * i);
}

glm::dvec3 inDeviceFrame(const int16_t* axes) {
    const auto share = [](int16_t counts) { return std::clamp(counts / kSpaceMouseFullScale, -1.0, 1.0); };
    return {share(axes[0]), -share(axes[2]), share(axes[1])};
}

} // namespace

ReportVerdict parseSpaceMouseReport(std::span<const uint8_t> report, SpaceMouseState& state) {
    if (report.empty())
        return ReportVerdict::Malformed;
    const std::span<int16_t> axes(state.axes);
    switch (report[0]) {
    case kTranslationReport:
        if (report.size() >= kSixAxes)
            readAxes(report, axes);
        else if (report.size() == kThreeAxes)
            readAxes(report, axes.first(3));
        else
            return ReportVerdict::Malformed;
        return ReportVerdict::Reading;
    case kRotationReport:
        if (report.size() < kThreeAxes)
            return ReportVerdict::Malformed;
        readAxes(report, axes.last(3));
        return ReportVerdict::Reading;
    case kButtonsReport: {
        if (report.size() < 2)
            return ReportVerdict::Malformed;
        state.buttons = 0;
        for (size_t i = 1; i < std::min<size_t>(report.size(), 5); ++i)
            state.buttons |= uint32_t{report[i]} << 8 * (i - 1);
        return ReportVerdict::Reading;
    }
    default:
        return ReportVerdict::Ignored;
    }
}

SpaceMouseDeflection deflectionOf(const SpaceMouseState& state) {
    return {inDeviceFrame(state.axes.data()), inDeviceFrame(state.axes.data() + 3)};
}

} // namespace touchstone

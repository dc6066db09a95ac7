#include "devices/hid/hid_protocol.h"

#include "devices/hid/raw_report.h"
#include "devices/hid/spacemouse_report.h"
#include "devices/hid/woodenhaptics_report.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchstone {

namespace {

/// `value` in units of 1 / `scale`, clamped to the range of T. Non-finite values are zero.
template <class T>
T quantised(double value, double scale) {
    const double counts = std::trunc(value * scale);
    if (!std::isfinite(counts))
        return 0;
    return static_cast<T>(std::clamp(counts, static_cast<double>(std::numeric_limits<T>::min()),
                                     static_cast<double>(std::numeric_limits<T>::max())));
}

class SpaceMouseProtocol final : public HidProtocol {
  public:
    void restart(DeviceReading& reading) override {
        state_ = {};
        reading = {};
        reading.valid = true; // a SpaceMouse at rest sends no reports
    }
    ReportVerdict take(std::span<const uint8_t> report, DeviceReading& reading, uint64_t&) override {
        const ReportVerdict verdict = parseSpaceMouseReport(report, state_);
        if (verdict != ReportVerdict::Reading)
            return verdict;
        const SpaceMouseDeflection deflection = deflectionOf(state_);
        reading.push = deflection.push;
        reading.turn = deflection.turn;
        reading.buttons = state_.buttons;
        reading.valid = true;
        return verdict;
    }
    [[nodiscard]] bool silenceHolds() const override { return state_.axes == decltype(state_.axes){}; }
    [[nodiscard]] bool driven() const override { return false; }
    size_t command(const ForceOrder&, std::span<uint8_t, kMaxReportSize>) override { return 0; }

  private:
    SpaceMouseState state_;
};

class WoodenProtocol final : public HidProtocol {
  public:
    explicit WoodenProtocol(ArmKinematics arm) : arm_(std::move(arm)) {}

    void restart(DeviceReading& reading) override {
        unwrapper_.restart();
        reading = {};
        known_ = false;
    }
    ReportVerdict take(std::span<const uint8_t> report, DeviceReading& reading, uint64_t&) override {
        const auto parsed = parseWoodenReport(report);
        if (!parsed)
            return ReportVerdict::Malformed;
        pose_ = poseOf(arm_, unwrapper_.follow(parsed->counts));
        known_ = true;
        reading.position = pose_.position;
        reading.orientation = pose_.orientation;
        reading.valid = true;
        return ReportVerdict::Reading;
    }
    size_t command(const ForceOrder& order, std::span<uint8_t, kMaxReportSize> report) override {
        std::array<int16_t, 3> milliamperes{};
        if (known_) {
            const Currents currents = currentsOf(arm_, pose_, order.force);
            for (size_t m = 0; m < milliamperes.size(); ++m)
                milliamperes[m] = quantised<int16_t>(currents[m], 1e3);
        }
        const auto bytes = woodenCommand(milliamperes);
        std::copy(bytes.begin(), bytes.end(), report.begin());
        return bytes.size();
    }

  private:
    ArmKinematics arm_;
    CountUnwrapper unwrapper_;
    ArmPose pose_;
    bool known_ = false;
};

class RawProtocol final : public HidProtocol {
  public:
    explicit RawProtocol(std::optional<ArmKinematics> arm) : arm_(std::move(arm)) {}

    void restart(DeviceReading& reading) override {
        reading = {};
        started_ = known_ = false;
    }
    ReportVerdict take(std::span<const uint8_t> report, DeviceReading& reading, uint64_t& lost) override {
        const auto state = parseRawState(report);
        const bool counts = state && (state->flags & kRawCounts) != 0;
        if (!state || (counts && !arm_))
            return ReportVerdict::Malformed;
        if (started_) {
            const SequenceStep step = sequenceStep(heard_, state->sequence);
            if (!step.fresh)
                return ReportVerdict::Repeated;
            lost += step.lost;
        }
        started_ = true;
        heard_ = state->sequence;
        if (static_cast<int32_t>(state->answered - said_) > 0) // another process has sent commands to it
            said_ = state->answered;
        known_ = (state->flags & kRawHomed) != 0 && (state->flags & kRawFault) == 0;
        reading.valid = known_;
        reading.buttons = state->buttons;
        if (counts)
            placeByCounts(*state, reading);
        else
            for (int i = 0; i < 3; ++i)
                reading.position[i] = 1e-9 * state->axes[static_cast<size_t>(i)];
        byCounts_ = counts;
        return ReportVerdict::Reading;
    }
    size_t command(const ForceOrder& order, std::span<uint8_t, kMaxReportSize> report) override {
        RawCommand command{.kind = byCounts_ ? kRawCurrent : kRawForce,
                           .sequence = ++said_,
                           .answers = heard_,
                           .watchdogMs = static_cast<uint16_t>(1e3 * kServoSilence)};
        constexpr double kMicro = 1e6;
        if (known_ && byCounts_) {
            const Currents currents = currentsOf(*arm_, pose_, order.force);
            for (size_t i = 0; i < kMaxMotors; ++i)
                command.values[i] = quantised<int32_t>(currents[i], kMicro);
        } else if (known_) {
            for (size_t i = 0; i < 3; ++i) {
                command.values[i] = quantised<int32_t>(order.force[static_cast<int>(i)], kMicro);
                command.values[3 + i] = quantised<int32_t>(order.torque[static_cast<int>(i)], kMicro);
            }
        }
        constexpr double kNano = 1e9;
        for (size_t i = 0; i < command.location.size(); ++i)
            command.location[i] = quantised<int32_t>(order.location[static_cast<int>(i)], kNano);
        const auto bytes = rawCommand(command);
        report[0] = 0; // report id 0: none
        std::copy(bytes.begin(), bytes.end(), report.begin() + 1);
        return 1 + bytes.size();
    }

  private:
    void placeByCounts(const RawState& state, DeviceReading& reading) {
        std::array<double, kMaxMotors> counts{};
        std::copy(state.axes.begin(), state.axes.end(), counts.begin());
        pose_ = poseOf(*arm_, counts);
        reading.position = pose_.position;
        reading.orientation = pose_.orientation;
    }

    std::optional<ArmKinematics> arm_;
    ArmPose pose_;
    uint32_t heard_ = 0, said_ = 0;
    bool started_ = false, known_ = false, byCounts_ = false;
};

} // namespace

std::unique_ptr<HidProtocol> makeSpaceMouseProtocol() {
    return std::make_unique<SpaceMouseProtocol>();
}

std::unique_ptr<HidProtocol> makeProtocol(const DeviceFile& file) {
    if (file.protocol == DeviceProtocol::WoodenHaptics)
        return std::make_unique<WoodenProtocol>(*file.arm);
    return std::make_unique<RawProtocol>(file.arm);
}

} // namespace touchstone

// The parsers: exact bytes in, exact numbers out, and nothing out of what is malformed.

#include "devices/hid/hid_protocol.h"
#include "devices/hid/raw_report.h"
#include "devices/hid/spacemouse_report.h"
#include "devices/hid/woodenhaptics_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string_view>
#include <vector>

namespace touchstone {
namespace {

using Bytes = std::vector<uint8_t>;

TEST(SpaceMouseReport, ReadsTranslationRotationAndButtons) {
    SpaceMouseState state;
    // +350, -350, 100: little endian.
    EXPECT_EQ(parseSpaceMouseReport(Bytes{1, 0x5E, 0x01, 0xA2, 0xFE, 0x64, 0x00}, state),
              ReportVerdict::Reading);
    EXPECT_EQ(state.axes, (std::array<int16_t, 6>{350, -350, 100, 0, 0, 0}));
    EXPECT_EQ(parseSpaceMouseReport(Bytes{2, 1, 0, 2, 0, 0xFD, 0xFF}, state), ReportVerdict::Reading);
    EXPECT_EQ(state.axes, (std::array<int16_t, 6>{350, -350, 100, 1, 2, -3}));
    EXPECT_EQ(parseSpaceMouseReport(Bytes{3, 0x02}, state), ReportVerdict::Reading);
    EXPECT_EQ(state.buttons, 2u);
    EXPECT_EQ(parseSpaceMouseReport(Bytes{3, 0x01, 0x80, 0x00, 0x40, 0xFF, 0xFF}, state),
              ReportVerdict::Reading);
    EXPECT_EQ(state.buttons, 0x40008001u) << "the first 32 buttons";
}

TEST(SpaceMouseReport, NewerModelsPackAllAxesIntoReportOne) {
    SpaceMouseState state;
    EXPECT_EQ(parseSpaceMouseReport(Bytes{1, 1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 0xFA, 0xFF}, state),
              ReportVerdict::Reading);
    EXPECT_EQ(state.axes, (std::array<int16_t, 6>{1, 2, 3, 4, 5, -6}));
}

TEST(SpaceMouseReport, WhatIsMalformedChangesNothing) {
    const SpaceMouseState before{{1, 2, 3, 4, 5, 6}, 7};
    for (const Bytes& report :
         {Bytes{}, Bytes{1}, Bytes{1, 2, 3, 4, 5, 6}, Bytes{1, 2, 3, 4, 5, 6, 7, 8},
          Bytes{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, Bytes{2, 0, 0, 0, 0, 0}, Bytes{3}}) {
        SpaceMouseState state = before;
        EXPECT_EQ(parseSpaceMouseReport(report, state), ReportVerdict::Malformed) << report.size();
        EXPECT_EQ(state, before);
    }
    SpaceMouseState state = before;
    EXPECT_EQ(parseSpaceMouseReport(Bytes{23, 100}, state), ReportVerdict::Ignored) << "the battery";
    EXPECT_EQ(state, before);
}

TEST(SpaceMouseReport, DeflectionIsInTheDeviceFrameAndCut) {
    // The cap: x right, y towards the user, z down. The device frame: x right, y up, z towards the user.
    const SpaceMouseDeflection deflection = deflectionOf({{350, 175, -70, -700, 32767, -32768}, 0});
    EXPECT_EQ(deflection.push, glm::dvec3(1.0, 0.2, 0.5));
    EXPECT_EQ(deflection.turn, glm::dvec3(-1.0, 1.0, 1.0));
}

TEST(WoodenReport, ReadsSixCountsAndTheInfoWord) {
    const auto report = parseWoodenReport(Bytes{1, 0, 0xFF, 0xFF, 0, 0x80, 0xFF, 0x7F, 5, 0, 6, 0, 1, 0});
    ASSERT_TRUE(report);
    EXPECT_EQ(report->counts, (std::array<int16_t, 6>{1, -1, -32768, 32767, 5, 6}));
    EXPECT_EQ(report->info, 1);
    for (size_t size = 0; size < 70; ++size)
        EXPECT_EQ(parseWoodenReport(Bytes(size, 0)).has_value(), size == 14) << size;
}

TEST(WoodenReport, WritesReportIdCurrentsAndNoCommand) {
    EXPECT_EQ(woodenCommand({1000, -2, -32768}),
              (std::array<uint8_t, 15>{0, 0xE8, 0x03, 0xFE, 0xFF, 0x00, 0x80, 0, 0, 0, 0, 0, 0, 0, 0}));
}

TEST(WoodenReport, CountsGoOnBeyondSixteenBits) {
    CountUnwrapper unwrapper;
    double expected = 32000.0;
    EXPECT_EQ(unwrapper.follow({32000, 0, 0, 0, 0, -5})[0], expected);
    for (int i = 0; i < 20; ++i) {
        expected += 7000.0;
        const auto wrapped = static_cast<int16_t>(static_cast<int64_t>(expected));
        EXPECT_EQ(unwrapper.follow({wrapped, 0, 0, 0, 0, -5})[0], expected);
    }
    EXPECT_EQ(unwrapper.follow({0, 0, 0, 0, 0, -5})[5], -5.0);
    unwrapper.restart();
    EXPECT_EQ(unwrapper.follow({100, 0, 0, 0, 0, 0})[0], 100.0);
}

TEST(RawReport, ChecksumIsThatOfEthernet) {
    const std::string_view check = "123456789";
    EXPECT_EQ(crc32({reinterpret_cast<const uint8_t*>(check.data()), check.size()}), 0xCBF43926u);
}

TEST(RawReport, StatesAndCommandsHaveTheDocumentedBytes) {
    const auto state = rawState({.flags = kRawHomed,
                                 .sequence = 0x04030201,
                                 .deviceTimeUs = 0x08070605,
                                 .answered = 9,
                                 .buttons = 0x80000001,
                                 .axes = {-1, 2, 3, 4, 5, 0x7FFFFFFF}});
    const std::array<uint8_t, 44> head{
        0x54, 1,    1, 2, 1, 2, 3, 4, 5, 6, 7, 8, 9, 0, 0, 0, 1, 0, 0,    0x80, 0xFF, 0xFF,
        0xFF, 0xFF, 2, 0, 0, 0, 3, 0, 0, 0, 4, 0, 0, 0, 5, 0, 0, 0, 0xFF, 0xFF, 0xFF, 0x7F};
    for (size_t i = 0; i < head.size(); ++i)
        EXPECT_EQ(state[i], head[i]) << i;
    for (size_t i = head.size(); i < 60; ++i)
        EXPECT_EQ(state[i], 0) << i;
    EXPECT_EQ(readU32(state, 60), crc32(std::span(state).first(60)));

    const auto command = rawCommand({.kind = kRawForce,
                                     .sequence = 7,
                                     .answers = 0x01020304,
                                     .watchdogMs = 20,
                                     .values = {1000000, -1, 0, 0, 0, 0},
                                     .location = {8000000, -3}});
    EXPECT_EQ(command[2], 2);
    EXPECT_EQ(readU32(command, 4), 7u);
    EXPECT_EQ(readU32(command, 8), 0x01020304u);
    EXPECT_EQ(readI32(command, 12), 1000000);
    EXPECT_EQ(readI32(command, 16), -1);
    EXPECT_EQ(readU16(command, 36), 20);
    EXPECT_EQ(readI32(command, 40), 8000000) << "nm";
    EXPECT_EQ(readI32(command, 44), -3);
    const auto back = parseRawCommand(command);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->values[0], 1000000);
    EXPECT_EQ(back->location[1], -3);
    EXPECT_EQ(back->answers, 0x01020304u);
}

TEST(RawReport, EveryBitCounts) {
    const auto good = rawState({.flags = kRawHomed, .sequence = 5, .axes = {1, 2, 3, 0, 0, 0}});
    ASSERT_TRUE(parseRawState(good));
    for (size_t bit = 0; bit < 8 * good.size(); ++bit) {
        auto bad = good;
        bad[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
        EXPECT_FALSE(parseRawState(bad)) << "bit " << bit;
    }
    for (size_t size = 0; size < good.size(); ++size)
        EXPECT_FALSE(parseRawState(std::span(good).first(size)));
    EXPECT_FALSE(parseRawState(rawCommand({}))) << "the other direction";
}

TEST(SequenceNumbers, TellRepeatsGapsAndRestarts) {
    EXPECT_TRUE(sequenceStep(5, 6).fresh);
    EXPECT_EQ(sequenceStep(5, 6).lost, 0u);
    EXPECT_EQ(sequenceStep(5, 9).lost, 3u);
    EXPECT_FALSE(sequenceStep(5, 5).fresh);
    EXPECT_FALSE(sequenceStep(50, 45).fresh) << "overtaken";
    EXPECT_FALSE(sequenceStep(2, 0xFFFFFFFE).fresh) << "overtaken across the wrap";
    EXPECT_EQ(sequenceStep(0xFFFFFFFE, 1).lost, 2u) << "across the wrap";
    EXPECT_TRUE(sequenceStep(500000, 1).fresh) << "the firmware was restarted";
    EXPECT_EQ(sequenceStep(500000, 1).lost, 0u);
}

DeviceFile deviceFile(const char* name) {
    return readDeviceFile(std::string(TOUCHSTONE_SOURCE "/devices/files/") + name);
}

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// What every protocol must hold whatever comes: a place that is a number, and a command no larger than what
/// the device may get.
void storm(HidProtocol& protocol, std::mt19937_64& random, const std::vector<Bytes>& seeds,
           const std::function<void(std::span<const uint8_t>)>& checkCommand) {
    DeviceReading reading;
    protocol.restart(reading);
    std::array<uint8_t, kMaxReportSize> command{};
    uint64_t lost = 0;
    int readings = 0;
    for (int i = 0; i < 100000; ++i) {
        Bytes report = seeds[random() % seeds.size()];
        switch (random() % 4) {
        case 0: // noise of any length
            report.resize(random() % 66);
            for (uint8_t& byte : report)
                byte = static_cast<uint8_t>(random());
            break;
        case 1: // the head of a good one
            report.resize(random() % (report.size() + 1));
            break;
        case 2: // a few bytes changed
            for (int k = 0; k < 3; ++k)
                report[random() % report.size()] = static_cast<uint8_t>(random());
            break;
        default:
            break;
        }
        if (protocol.take(report, reading, lost) == ReportVerdict::Reading)
            ++readings;
        ASSERT_TRUE(finite(reading.position) && finite(reading.push) && finite(reading.turn));
        ASSERT_LE(glm::length(reading.push), std::sqrt(3.0));
        ForceOrder order;
        order.force = glm::dvec3(static_cast<double>(random() % 2001) - 1000.0, 1e300, std::nan(""));
        if (random() % 2 == 0)
            order.force = glm::dvec3(5.0, -5.0, static_cast<double>(random() % 11));
        const size_t length = protocol.command(order, command);
        ASSERT_LE(length, command.size());
        checkCommand(std::span(command).first(length));
    }
    EXPECT_GT(readings, 1000) << "too wild a storm to mean anything";
}

TEST(HidFuzz, NoReportBreaksAProtocol) {
    std::mt19937_64 random(20251121);
    const auto spaceMouse = makeSpaceMouseProtocol();
    storm(*spaceMouse, random, {{1, 1, 2, 3, 4, 5, 6}, {2, 1, 2, 3, 4, 5, 6}, {3, 1}, Bytes(13, 1)},
          [](std::span<const uint8_t> command) { EXPECT_TRUE(command.empty()); });

    const DeviceFile wooden = deviceFile("woodenhaptics.json");
    storm(*makeProtocol(wooden), random, {Bytes(14, 3), Bytes(14, 0xF0)},
          [&](std::span<const uint8_t> command) {
              ASSERT_EQ(command.size(), 15u);
              for (size_t m = 0; m < 3; ++m)
                  ASSERT_LE(std::abs(readI16(command, 1 + 2 * m)), 2000);
              for (size_t i = 7; i < 15; ++i)
                  ASSERT_EQ(command[i], 0);
          });

    std::vector<Bytes> states;
    for (uint32_t i = 0; i < 4000; ++i) {
        const auto state =
            rawState({.flags = static_cast<uint8_t>(random() % 16),
                      .sequence = static_cast<uint32_t>(random()),
                      .axes = {static_cast<int32_t>(random()), static_cast<int32_t>(random()), 7}});
        states.emplace_back(state.begin(), state.end());
    }
    for (const char* name : {"diy_position.json", "diy_gantry.json"})
        storm(*makeProtocol(deviceFile(name)), random, states, [&](std::span<const uint8_t> command) {
            ASSERT_EQ(command.size(), 65u);
            ASSERT_EQ(command[0], 0);
            const auto parsed = parseRawCommand(command.subspan(1));
            ASSERT_TRUE(parsed);
            for (const int32_t value : parsed->values) {
                ASSERT_LE(std::abs(int64_t{value}), parsed->kind == kRawCurrent ? 1'000'000 : 2'147'483'648);
            }
        });
}

TEST(RawProtocol, GoesOnCountingWhereAnotherProcessLeftOff) {
    const auto protocol = makeProtocol(deviceFile("diy_position.json"));
    DeviceReading reading;
    protocol->restart(reading);
    uint64_t lost = 0;
    std::array<uint8_t, kMaxReportSize> bytes{};
    const auto next = [&](uint32_t sequence, uint32_t answered) {
        EXPECT_EQ(protocol->take(rawState({.flags = kRawHomed, .sequence = sequence, .answered = answered}),
                                 reading, lost),
                  ReportVerdict::Reading);
        (void)protocol->command(ForceOrder{}, bytes);
        return parseRawCommand(std::span(bytes).subspan(1))->sequence;
    };
    EXPECT_EQ(next(1, 700), 701u);
    EXPECT_EQ(next(2, 700), 702u) << "a state that is behind takes nothing back";
    protocol->restart(reading);
    EXPECT_EQ(next(3, 0), 703u) << "a firmware that began anew takes any";
}

TEST(RawProtocol, NamesPlacesAnswersAndKeepsStillUntilItKnowsThePlace) {
    const auto protocol = makeProtocol(deviceFile("diy_position.json"));
    DeviceReading reading;
    protocol->restart(reading);
    EXPECT_FALSE(reading.valid);
    std::array<uint8_t, kMaxReportSize> bytes{};
    const ForceOrder order{.force = {1.5, -2.0, 0.25}};
    ASSERT_EQ(protocol->command(order, bytes), 65u);
    EXPECT_EQ(parseRawCommand(std::span(bytes).subspan(1))->values[0], 0)
        << "no force before a place is known";
    uint64_t lost = 0;
    const auto at = [&](uint8_t flags, uint32_t sequence) {
        return protocol->take(
            rawState({.flags = flags, .sequence = sequence, .axes = {12'000'000, -1'000, 1}}), reading, lost);
    };
    EXPECT_EQ(at(kRawHomed, 41), ReportVerdict::Reading);
    EXPECT_TRUE(reading.valid);
    EXPECT_NEAR(glm::length(reading.position - glm::dvec3(0.012, -1e-6, 1e-9)), 0.0, 1e-15);
    (void)protocol->command(order, bytes);
    const auto command = parseRawCommand(std::span(bytes).subspan(1));
    EXPECT_EQ(command->kind, kRawForce);
    EXPECT_EQ(command->answers, 41u);
    EXPECT_EQ(command->watchdogMs, 20);
    EXPECT_EQ(command->values, (std::array<int32_t, 6>{1500000, -2000000, 250000, 0, 0, 0}));
    EXPECT_EQ(at(kRawHomed, 41), ReportVerdict::Repeated);
    EXPECT_EQ(at(kRawHomed, 44), ReportVerdict::Reading);
    EXPECT_EQ(lost, 2u);
    EXPECT_EQ(at(kRawHomed | kRawFault, 45), ReportVerdict::Reading);
    EXPECT_FALSE(reading.valid) << "a device that reports a fault is not to be trusted";
    EXPECT_EQ(at(0, 46), ReportVerdict::Reading);
    EXPECT_FALSE(reading.valid) << "not homed";
    EXPECT_EQ(at(kRawHomed | kRawCounts, 47), ReportVerdict::Malformed)
        << "counts, but no arm to make sense of them";
}

} // namespace
} // namespace touchstone

// Feeds what a device, a program or a device file may say to everything that reads it. It may be refused;
// what is taken must be a place, and what is answered must be within what the device may get.
#include "devices/external/external_packet.h"
#include "devices/hid/hid_protocol.h"
#include "devices/hid/raw_report.h"
#include "engine/core/error.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace touchstone {
namespace {

#define TOUCHSTONE_PROMISE(condition)                                                                        \
    do {                                                                                                     \
        if (!(condition)) {                                                                                  \
            std::fprintf(stderr, "a device breaks its promise: %s\n", #condition);                           \
            std::abort();                                                                                    \
        }                                                                                                    \
    } while (false)

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

DeviceFile shipped(const char* name) {
    return readDeviceFile(std::string(TOUCHSTONE_SOURCE "/devices/files/") + name);
}

void checkCommand(HidProtocol& protocol, const DeviceFile* file) {
    std::array<uint8_t, kMaxReportSize> report{};
    const size_t length = protocol.command({.force = {3.0, -7.0, 2.0}}, report);
    TOUCHSTONE_PROMISE(length <= report.size() && (length > 0) == protocol.driven());
    if (file == nullptr || !file->arm)
        return;
    for (size_t m = 0; m < 3; ++m) {
        const double amperes = file->protocol == DeviceProtocol::WoodenHaptics
                                   ? 1e-3 * readI16(report, 1 + 2 * m)
                                   : 1e-6 * readI32(report, 1 + 12 + 4 * m);
        const bool currents = file->protocol == DeviceProtocol::WoodenHaptics || report[1 + 2] == kRawCurrent;
        TOUCHSTONE_PROMISE(!currents || std::abs(amperes) <= file->arm->motors[m].maxCurrent);
    }
}

/// Reports of a length each. `sealed`: of our own protocol, with a good head and checksum, else nearly none
/// would get past them.
void feed(HidProtocol& protocol, const DeviceFile* file, std::span<const uint8_t> data, bool sealed) {
    DeviceReading reading;
    protocol.restart(reading);
    uint64_t lost = 0;
    while (!data.empty()) {
        const size_t length = std::min<size_t>(data[0] % 66, data.size() - 1);
        std::vector<uint8_t> report(data.begin() + 1, data.begin() + 1 + static_cast<ptrdiff_t>(length));
        data = data.subspan(1 + length);
        if (sealed) {
            report.resize(kRawReportSize);
            report[0] = kRawMagic;
            report[1] = kRawVersion;
            report[2] = kRawState;
            writeU32(report, 60, crc32(std::span(report).first(60)));
        }
        const ReportVerdict verdict = protocol.take(report, reading, lost);
        TOUCHSTONE_PROMISE(finite(reading.position) && finite(reading.push) && finite(reading.turn));
        TOUCHSTONE_PROMISE(std::abs(glm::length(reading.orientation) - 1.0) < 1e-9);
        TOUCHSTONE_PROMISE(verdict != ReportVerdict::Reading || !report.empty());
        checkCommand(protocol, file);
    }
}

void parseText(std::string_view text) {
    try {
        const DeviceFile file = parseDeviceFile(text, "fuzz.json");
        TOUCHSTONE_PROMISE(file.limits.maxForce >= 0.0 && file.limits.maxForce <= 100.0);
        if (file.arm) {
            const ArmPose pose = poseOf(*file.arm, {1e4, -1e4, 5.0, 0.0, 1.0, 2.0});
            TOUCHSTONE_PROMISE(finite(pose.position));
            const Currents currents = currentsOf(*file.arm, pose, {1.0, 2.0, 3.0});
            for (size_t m = 0; m < file.arm->motors.size(); ++m)
                TOUCHSTONE_PROMISE(std::abs(currents[m]) <= file.arm->motors[m].maxCurrent * (1.0 + 1e-12));
        }
    } catch (const Error&) {
    }
}

void one(std::span<const uint8_t> data) {
    static const DeviceFile wooden = shipped("woodenhaptics.json"), position = shipped("diy_position.json"),
                            gantry = shipped("diy_gantry.json");
    if (data.empty())
        return;
    const uint8_t kind = data[0];
    data = data.subspan(1);
    const bool sealed = (kind & 0x80) != 0;
    switch (kind & 7) {
    case 0:
        return feed(*makeSpaceMouseProtocol(), nullptr, data, false);
    case 1:
        return feed(*makeProtocol(wooden), &wooden, data, false);
    case 2:
        return feed(*makeProtocol(position), &position, data, sealed);
    case 3:
        return feed(*makeProtocol(gantry), &gantry, data, sealed);
    case 4:
        if (const auto place = parsePlacePacket(data))
            TOUCHSTONE_PROMISE(finite(place->position) &&
                               std::abs(glm::length(place->orientation) - 1.0) < 1e-9);
        return;
    default:
        return parseText({reinterpret_cast<const char*>(data.data()), data.size()});
    }
}

} // namespace
} // namespace touchstone

#ifdef TOUCHSTONE_LIBFUZZER
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    touchstone::one({data, size});
    return 0;
}
#else

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>

namespace touchstone {
namespace {

std::string textOf(const char* name) {
    std::ifstream in(std::string(TOUCHSTONE_SOURCE "/devices/files/") + name);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Breaks its promise by abort, which fails the test and names it.
TEST(DeviceFuzz, NothingThatIsSaidBreaksAPromise) {
    std::vector<std::vector<uint8_t>> seeds;
    for (const char* name : {"woodenhaptics.json", "diy_gantry.json"}) {
        const std::string text = textOf(name);
        seeds.emplace_back(1, uint8_t{5});
        seeds.back().insert(seeds.back().end(), text.begin(), text.end());
    }
    const auto place = placePacket({.position = {0.1, 0.2, 0.3}});
    seeds.emplace_back(1, uint8_t{4});
    seeds.back().insert(seeds.back().end(), place.begin(), place.end());
    std::mt19937_64 random(97);
    for (int i = 0; i < 60000; ++i) {
        std::vector<uint8_t> input = seeds[random() % seeds.size()];
        if (i % 3 != 0) { // reports of any kind
            input.assign(2 + random() % 400, 0);
            for (uint8_t& byte : input)
                byte = static_cast<uint8_t>(random());
            input[0] = static_cast<uint8_t>((random() % 4) | (random() & 0x80));
        }
        for (uint64_t k = random() % 4; k > 0; --k)
            input[1 + random() % (input.size() - 1)] = static_cast<uint8_t>(random());
        one(input);
    }
}

} // namespace
} // namespace touchstone
#endif

// What is written is what was meant, byte by byte as docs/recording.md says, and nothing else is read.

#include "engine/core/checksum.h"
#include "engine/core/error.h"
#include "engine/core/machine.h"
#include "haptics/recording/byte_stream.h"
#include "haptics/recording/recorded_settings.h"
#include "haptics/recording/recording_format.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

namespace touchstone {
namespace {

template <class Number>
Number numberAt(const std::vector<std::byte>& bytes, size_t at) {
    Number number{};
    std::memcpy(&number, bytes.data() + at, sizeof number);
    return number;
}

RecordedTick someTick() {
    RecordedTick tick;
    tick.tick = 0x0102030405060708;
    tick.time = 1.25;
    tick.dt = 1e-3;
    tick.sample.position = {0.1, -0.2, 0.3};
    tick.sample.orientation = glm::dquat(0.5, 0.5, -0.5, 0.5);
    tick.sample.buttons = 5;
    tick.sample.age = 2e-3;
    tick.sample.valid = true;
    tick.sample.limits.maxForce = 4.5;
    tick.sample.limits.press = 0.7;
    tick.poses = 0x1234;
    tick.settings = 7;
    tick.scene = 3;
    tick.late = tick.checkpoint = true;
    tick.wakeLatencyNs = -12;
    tick.stepNs = 3456;
    tick.hashes = {1, 2, 3, 4, 5, 6, 7, 0xfffffff8};
    tick.proxy = {1.0, 2.0, 3.0};
    tick.force = {4.0, 5.0, 6.0};
    tick.command = {7.0, 8.0, 9.0};
    tick.contacts = 2;
    tick.flags = 0x80000001;
    return tick;
}

/// Three ticks: as without clutch and zoom, with some, and with the same.
RecordedTicks mappedTicks() {
    RecordedTicks ticks{{someTick(), someTick(), someTick()}};
    DeviceMapping& mapping = ticks.ticks[1].sample.mapping;
    mapping.workspaceFromDevice.scale = 2.5;
    mapping.workspaceFromDevice.rotation = glm::dquat(0.5, 0.5, -0.5, 0.5);
    mapping.workspaceFromDevice.translation = {0.1, -0.2, 0.3};
    mapping.coupling = 0.25;
    ticks.ticks[2].sample.mapping = mapping;
    return ticks;
}

TEST(RecordingFormat, AMappingStandsBehindTheTicksWhereThereIsOne) {
    const RecordedTicks plain{{someTick(), someTick(), someTick()}};
    const size_t without = 4 + 3 * kTickSize;
    EXPECT_EQ(numberAt<uint32_t>(encode(plain), without), 0u);
    const std::vector<std::byte> bytes = encode(mappedTicks());
    ASSERT_EQ(bytes.size(), encode(plain).size() + 4 + 9 * 8) << "once for both ticks";
    EXPECT_EQ(numberAt<uint32_t>(bytes, without), 1u);
    EXPECT_EQ(numberAt<uint32_t>(bytes, without + 4), 1u);
    EXPECT_EQ(numberAt<double>(bytes, without + 8), 2.5);
    EXPECT_EQ(numberAt<double>(bytes, without + 72), 0.25);
    const auto ticks = std::get<RecordedTicks>(decode(4, bytes)).ticks;
    EXPECT_EQ(ticks[0].sample.mapping.workspaceFromDevice.scale, 1.0);
    EXPECT_EQ(ticks[0].sample.mapping.coupling, 1.0);
    for (const size_t i : {size_t{1}, size_t{2}}) {
        const DeviceMapping& mapping = ticks[i].sample.mapping;
        EXPECT_EQ(mapping.workspaceFromDevice.scale, 2.5);
        EXPECT_EQ(mapping.workspaceFromDevice.rotation, glm::dquat(0.5, 0.5, -0.5, 0.5));
        EXPECT_EQ(mapping.workspaceFromDevice.translation, glm::dvec3(0.1, -0.2, 0.3));
        EXPECT_EQ(mapping.coupling, 0.25);
    }
    EXPECT_EQ(encode(RecordedTicks{ticks}), bytes);
}

TEST(RecordingFormat, RefusesMappingsThatCannotBe) {
    const std::vector<std::byte> whole = encode(mappedTicks());
    const size_t at = 4 + 3 * kTickSize;
    const auto with = [&](size_t place, auto number) {
        std::vector<std::byte> bytes = whole;
        std::memcpy(bytes.data() + place, &number, sizeof number);
        return bytes;
    };
    EXPECT_THROW((void)decode(4, with(at, 2u)), Error) << "more than there are";
    EXPECT_THROW((void)decode(4, with(at + 4, 3u)), Error) << "of no tick";
    for (const double scale : {0.0, -1.0, std::nan(""), HUGE_VAL})
        EXPECT_THROW((void)decode(4, with(at + 8, scale)), Error) << scale;
    EXPECT_THROW((void)decode(4, with(at + 16, std::nan(""))), Error);
    EXPECT_THROW((void)decode(4, with(at + 48, HUGE_VAL)), Error);
    for (const double coupling : {-0.1, 1.1, std::nan("")})
        EXPECT_THROW((void)decode(4, with(at + 72, coupling)), Error) << coupling;
    EXPECT_THROW((void)decode(4, std::span(whole).first(whole.size() - 1)), Error);
}

DrivenState someDriven() {
    DrivenState state{.tick = 12, .count = 1};
    state.objects[0] = {.object = 2,
                        .now = {0.5, glm::dquat(0.6, 0.0, 0.8, 0.0), {0.1, -0.2, 0.3}},
                        .goal = {0.5, glm::dquat(1.0, 0.0, 0.0, 0.0), {0.0, 0.25, 0.0}},
                        .speed = 0.125,
                        .turn = 2.0};
    return state;
}

std::vector<RecordedItem> oneOfEach() {
    RecordedScene scene{3, {}};
    scene.identity.path = "a b/ü.glb";
    scene.identity.absolutePath = "/x";
    scene.identity.generated = true;
    scene.identity.fileSize = 12;
    scene.identity.fileHash = 0x1122334455667788;
    scene.identity.feltHash = 0x99;
    scene.identity.fit = Fit::Workspace;
    scene.identity.limits = DeviceLimits{.maxForce = 3.3};
    RecordedSettings settings{9, {}};
    settings.settings.friction = FrictionMode::Elastoplastic;
    settings.settings.forceEnabled = false;
    settings.settings.stiffness = 1.0 / 3.0;
    TouchCheckpoint checkpoint;
    checkpoint.tick = 77;
    checkpoint.scene = 3;
    checkpoint.previousTime = 0.076;
    checkpoint.size = 5;
    for (size_t i = 0; i < 5; ++i)
        checkpoint.bytes[i] = static_cast<std::byte>(200 + i);
    TouchCheckpoint other = checkpoint;
    other.hand = 3;
    return {recordingOrigin("touch", 1000.0),
            scene,
            settings,
            checkpoint,
            RecordedTicks{{someTick(), {}}},
            RecordedLoss{12},
            RecordedNote{5, "what"},
            RecordedEnd{99},
            RecordedHandTicks{2, mappedTicks()},
            RecordedHandState{other},
            RecordedTool{{.active = true, .tool = SculptTool::Drag, .object = 2, .radius = 0.003}},
            RecordedSculpt{7,
                           3,
                           0x55,
                           1,
                           {{.kind = SculptEntryKind::Begin, .object = 2},
                            {.tool = SculptTool::Imprint,
                             .object = 2,
                             .stamp = 1,
                             .tick = 80,
                             .centre = {0.1, -0.2, 0.3},
                             .motion = {0.4, 0.5, -0.6},
                             .radius = 0.07,
                             .strength = 0.25,
                             .falloff = 0.5}}},
            RecordedContacts{{{12, 1}, {20, 9}}},
            RecordedBodies{12, {std::byte{1}, std::byte{2}, std::byte{3}}},
            RecordedTextures{12, 1, {{0, 3, {0.5f}}, {2, 7, {0.25f, 1.0f, 0.125f}}}},
            RecordedStrokes{{{.tick = 80,
                              .object = 2,
                              .point = {0.1, -0.2, 0.3},
                              .normal = {0.0, 1.0, 0.0},
                              .radius = 0.07,
                              .change = -1e-6,
                              .most = 4096}}},
            RecordedLocations{2, {1e-3, -2e-3}, {{80, {0.008, 0.1}, {3e-3, 4e-3}}, {81, {0.008, 0.1}, {}}}},
            RecordedDriven{someDriven()}};
}

/// Bytes of one change of limits and their count.
size_t encodedLimits(const RecordedTicks& ticks) {
    std::vector<std::byte> bytes;
    ByteWriter writer(bytes);
    putLimits(writer, ticks.ticks[0].sample.limits);
    return 2 * sizeof(uint32_t) + bytes.size();
}

TEST(Checksum, IsTheCastagnoliPolynomialsAtAnyLength) {
    const std::string_view digits = "123456789"; // the check value of every catalogue of CRCs
    EXPECT_EQ(crc32c(std::as_bytes(std::span(digits))), 0xe3069283u);
    const std::vector<std::byte> zeros(32); // RFC 3720, B.4
    EXPECT_EQ(crc32c(zeros), 0x8a9136aau);
    for (size_t cut = 0; cut <= digits.size(); ++cut)
        EXPECT_EQ(crc32c(std::as_bytes(std::span(digits.substr(cut))),
                         crc32c(std::as_bytes(std::span(digits.substr(0, cut))))),
                  0xe3069283u);
}

TEST(Machine, NamesTheBuildAndTheProcessor) {
    EXPECT_EQ(buildIdentity().size(), 40u) << buildIdentity(); // SHA-1, hexadecimal
    EXPECT_FALSE(compilerName().empty());
    EXPECT_FALSE(processorName().empty());
}

TEST(RecordingFormat, ATickStandsWhereTheDocumentSays) {
    const std::vector<std::byte> bytes = encode(RecordedTicks{{someTick()}});
    ASSERT_GE(bytes.size(), 4 + kTickSize);
    EXPECT_EQ(numberAt<uint32_t>(bytes, 4 + kTickSize), 0u) << "mappings";
    EXPECT_EQ(numberAt<uint32_t>(bytes, 4 + kTickSize + 4), 1u) << "limits, of the first tick";
    EXPECT_EQ(numberAt<uint32_t>(bytes, bytes.size() - 8), 1u) << "poses";
    EXPECT_EQ(numberAt<uint32_t>(bytes, bytes.size() - 4), 0x1234u);
    EXPECT_EQ(numberAt<uint32_t>(bytes, 0), 1u);
    const auto tick = std::vector(bytes.begin() + 4, bytes.end());
    EXPECT_EQ(numberAt<uint64_t>(tick, 0), 0x0102030405060708u);
    EXPECT_EQ(tick[0], std::byte{8}) << "little endian";
    EXPECT_EQ(numberAt<double>(tick, 8), 1.25);
    EXPECT_EQ(numberAt<double>(tick, 16), 1e-3);
    EXPECT_EQ(numberAt<double>(tick, 32), -0.2);
    EXPECT_EQ(numberAt<double>(tick, 56), -0.5) << "y of the orientation";
    EXPECT_EQ(numberAt<double>(tick, 80), 2e-3);
    EXPECT_EQ(numberAt<uint32_t>(tick, 88), 5u);
    EXPECT_EQ(numberAt<uint32_t>(tick, 92), 7u);
    EXPECT_EQ(numberAt<uint32_t>(tick, 96), 3u);
    EXPECT_EQ(numberAt<uint32_t>(tick, 100), 1u + 2u + 8u);
    EXPECT_EQ(numberAt<int32_t>(tick, 104), -12);
    EXPECT_EQ(numberAt<int32_t>(tick, 108), 3456);
    EXPECT_EQ(numberAt<uint32_t>(tick, 112), 1u);
    EXPECT_EQ(numberAt<uint32_t>(tick, 140), 0xfffffff8u);
    EXPECT_EQ(numberAt<double>(tick, 144), 1.0);
    EXPECT_EQ(numberAt<double>(tick, 168), 4.0);
    EXPECT_EQ(numberAt<double>(tick, 192), 7.0);
    EXPECT_EQ(numberAt<uint32_t>(tick, 216), 2u);
    EXPECT_EQ(numberAt<uint32_t>(tick, 220), 0x80000001u);
}

TEST(RecordingFormat, EveryItemReadsBackToTheSameBytes) {
    const std::vector<RecordedItem> items = oneOfEach();
    ASSERT_EQ(items.size(), kChunkNames.size());
    for (size_t i = 0; i < items.size(); ++i) {
        ASSERT_EQ(items[i].index(), i);
        const std::vector<std::byte> bytes = encode(items[i]);
        EXPECT_EQ(encode(decode(i, bytes)), bytes) << kChunkNames[i];
    }
    const auto scene = std::get<RecordedScene>(decode(1, encode(items[1])));
    EXPECT_EQ(scene.identity.path, "a b/ü.glb");
    EXPECT_EQ(scene.identity.limits.value().maxForce, 3.3);
    EXPECT_EQ(scene.identity.fit, Fit::Workspace);
    EXPECT_EQ(std::get<RecordedSettings>(decode(2, encode(items[2]))).settings,
              std::get<RecordedSettings>(items[2]).settings);
    const auto ticks = std::get<RecordedTicks>(decode(4, encode(items[4]))).ticks;
    ASSERT_EQ(ticks.size(), 2u);
    EXPECT_EQ(ticks[0].hashes, someTick().hashes);
    EXPECT_EQ(ticks[0].sample.orientation, someTick().sample.orientation);
    EXPECT_EQ(ticks[0].sample.limits.maxForce, 4.5);
    EXPECT_EQ(ticks[0].sample.limits.press, 0.7);
    EXPECT_EQ(ticks[1].sample.limits, DeviceLimits{});
    EXPECT_EQ(ticks[0].poses, 0x1234u);
    EXPECT_EQ(std::get<RecordedHandTicks>(decode(8, encode(items[8]))).hand, 2u);
    EXPECT_EQ(std::get<RecordedHandState>(decode(9, encode(items[9]))).checkpoint.hand, 3u);
    EXPECT_EQ(std::get<RecordedTool>(decode(10, encode(items[10]))).tool,
              std::get<RecordedTool>(items[10]).tool);
    const auto sculpt = std::get<RecordedSculpt>(decode(11, encode(items[11])));
    EXPECT_EQ(sculpt.entries, std::get<RecordedSculpt>(items[11]).entries);
    EXPECT_EQ(encode(sculpt).size(), 24u + 2u * kSculptEntrySize);
}

/// Of a newer program, or damaged in a way that no checksum sees.
TEST(RecordingFormat, AToolThatCannotBeIsRefused) {
    for (const LiveTool& tool :
         {LiveTool{.radius = 0.0}, LiveTool{.radius = NAN}, LiveTool{.strength = 0.0},
          LiveTool{.strength = 1.5}, LiveTool{.falloff = -0.1}, LiveTool{.resistance = INFINITY},
          LiveTool{.tool = static_cast<SculptTool>(17)}})
        EXPECT_THROW((void)decode(10, encode(RecordedTool{tool})), Error);
    SculptEntry entry;
    entry.kind = static_cast<SculptEntryKind>(9);
    EXPECT_THROW((void)decode(11, encode(RecordedSculpt{7, 3, 0, 0, {entry}})), Error);
}

TEST(RecordingFormat, AHandThatCannotBeIsRefused) {
    for (const uint32_t hand : {0u, static_cast<uint32_t>(kMaxHands), 0xffffffffu}) {
        EXPECT_THROW((void)decode(8, encode(RecordedHandTicks{hand, mappedTicks()})), Error) << hand;
        RecordedHandState state;
        state.checkpoint.hand = hand;
        EXPECT_THROW((void)decode(9, encode(state)), Error) << hand;
    }
}

/// The ticks of format 1 end behind themselves, or behind their mappings.
TEST(RecordingFormat, ReadsTheTicksOfFormat1) {
    for (const bool mapped : {false, true}) {
        RecordedTicks ticks = mapped ? mappedTicks() : RecordedTicks{{someTick(), someTick()}};
        for (RecordedTick& tick : ticks.ticks)
            tick.sample.limits = DeviceLimits{}, tick.poses = 0;
        std::vector<std::byte> bytes = encode(ticks);
        const size_t limits = encodedLimits(ticks);
        bytes.resize(bytes.size() - limits - sizeof(uint32_t)); // without limits and poses
        if (!mapped)
            bytes.resize(bytes.size() - sizeof(uint32_t));
        RecordedItem item = decode(4, bytes, 1);
        const std::vector<RecordedTick>& read = std::get<RecordedTicks>(item).ticks;
        ASSERT_EQ(read.size(), ticks.ticks.size());
        for (size_t i = 0; i < read.size(); ++i) {
            EXPECT_EQ(read[i].hashes, ticks.ticks[i].hashes);
            EXPECT_EQ(read[i].sample.mapping.coupling, ticks.ticks[i].sample.mapping.coupling);
        }
        EXPECT_THROW((void)decode(4, bytes, 2), Error) << "and of no other";
    }
}

TEST(RecordingFormat, APayloadThatIsTooShortOrTooLongIsRefused) {
    for (const RecordedItem& item : oneOfEach()) {
        std::vector<std::byte> bytes = encode(item);
        for (size_t length = 0; length < bytes.size(); ++length)
            EXPECT_THROW((void)decode(item.index(), std::span(bytes).first(length)), Error)
                << kChunkNames[item.index()] << " of " << length;
        bytes.push_back(std::byte{0});
        EXPECT_THROW((void)decode(item.index(), bytes), Error) << kChunkNames[item.index()];
    }
}

TEST(RecordingFormat, HoldsEverySettingToTheLastBit) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    // Whatever --set can make, and --set itself knows no field that a recording does not hold.
    for (int turn = 0; turn < 300; ++turn) {
        HapticSettings settings;
        for (const auto& info : settingFields()) {
            double number = info.low + share(random) * (info.high - info.low);
            if (info.whole)
                number = std::floor(number);
            const std::string value = info.words.empty()
                                          ? std::to_string(number)
                                          : std::string(info.words[random() % info.words.size()]);
            ASSERT_EQ(setSetting(settings, info.name, value), "");
        }
        std::vector<std::byte> bytes;
        ByteWriter writer(bytes);
        putSettings(writer, settings);
        ByteReader reader(bytes);
        EXPECT_EQ(getSettings(reader), settings);
    }
}

/// Settings with one named number in place of another.
std::vector<std::byte> settingsWith(const std::string& name, double value) {
    std::vector<std::byte> bytes;
    ByteWriter writer(bytes);
    writer.put(uint16_t{1});
    writer.put(name);
    writer.put(value);
    return bytes;
}

TEST(RecordingFormat, RefusesSettingsThatCannotBe) {
    for (const auto& [name, value] : {std::pair<std::string, double>{"friction", 9.0},
                                      {"friction", -1.0},
                                      {"friction", 0.5},
                                      {"friction", std::nan("")},
                                      {"proxyRadius", 1.0},
                                      {"proxyRadius", std::nan("")},
                                      {"iterationBudget", 0.0},
                                      {"iterationBudget", 1e300},
                                      {"iterationBudget", 3.5},
                                      {"noSuchSetting", 0.0}}) {
        const std::vector<std::byte> bytes = settingsWith(name, value);
        ByteReader reader(bytes);
        EXPECT_THROW((void)getSettings(reader), Error) << name << " " << value;
    }
    const std::vector<std::byte> bytes = settingsWith("stiffness", 321.0);
    ByteReader reader(bytes);
    HapticSettings expected; // what is not there keeps its default
    expected.stiffness = 321.0;
    EXPECT_EQ(getSettings(reader), expected);
}

TEST(StageHashes, AreThoseOfTheDocument) {
    // state = (state ^ word) * 9e3779b97f4a7c15, state ^= state >> 32, over the proxy's three doubles.
    StageTrace trace;
    trace.proxy[1] = {1.0, -2.0, 0.5};
    uint64_t state = 0x243f6a8885a308d3;
    for (const uint64_t word : {0x3ff0000000000000u, 0xc000000000000000u, 0x3fe0000000000000u}) {
        state = (state ^ word) * 0x9e3779b97f4a7c15;
        state ^= state >> 32;
    }
    EXPECT_EQ(stageHashes(trace, {})[static_cast<size_t>(Stage::Proxy)],
              static_cast<uint32_t>((state * 0x9e3779b97f4a7c15) >> 32));
}

TEST(StageHashes, EachStageTellsOfItsOwnOutputsOnly) {
    const StageHashes still = stageHashes({}, {});
    const auto changed = [&](const std::function<void(StageTrace&, HapticOutput&)>& change) {
        StageTrace trace;
        HapticOutput output;
        change(trace, output);
        const StageHashes hashes = stageHashes(trace, output);
        std::string stages;
        for (size_t i = 0; i < kStageCount; ++i)
            if (hashes[i] != still[i])
                stages += std::string(kStageNames[i]) + " ";
        return stages;
    };
    EXPECT_EQ(changed([](auto&, auto& o) { o.hip.x = 1e-300; }), "sample ");
    EXPECT_EQ(changed([](auto&, auto& o) { o.hipVelocity.z = -0.0; }), "sample ");
    EXPECT_EQ(changed([](auto& t, auto&) { t.proxy[0].y = 1.0; }), "contact ");
    EXPECT_EQ(changed([](auto& t, auto&) { t.reference = 0; }), "contact ");
    EXPECT_EQ(changed([](auto& t, auto&) { t.proxy[1].y = 1.0; }), "proxy ");
    EXPECT_EQ(changed([](auto& t, auto&) { t.proxy[2].y = 1.0; }), "shading ");
    EXPECT_EQ(changed([](auto&, auto& o) { o.normal.y = 1.0; }), "texture ");
    EXPECT_EQ(changed([](auto&, auto& o) { o.triangle = 4; }), "texture ");
    EXPECT_EQ(changed([](auto&, auto& o) { o.proxy.y = 1.0; }), "friction ");
    EXPECT_EQ(changed([](auto&, auto& o) { o.friction = FrictionState::Sliding; }), "friction ");
    EXPECT_EQ(changed([](auto&, auto& o) { o.force.y = 1.0; }), "force ");
    EXPECT_EQ(changed([](auto&, auto& o) { o.commandInWorkspace.y = 1.0; }), "safety ");
    EXPECT_EQ(changed([](auto&, auto& o) { o.flags = 0u | TickFlag::ForceLimited; }), "safety ");
    EXPECT_EQ(changed([](auto&, auto& o) { o.flags = 0u | TickFlag::Teleported; }), "force safety ");
}

TEST(RecordingFormat, EachBitOfATickIsItsOwn) {
    for (int bit = 0; bit < 6; ++bit) {
        RecordedTick tick;
        tick.sample.valid = bit == 0;
        tick.late = bit == 1;
        tick.missed = bit == 2;
        tick.checkpoint = bit == 3;
        tick.sample.begins = bit == 4;
        tick.sample.inSight = bit == 5;
        const std::vector<std::byte> bytes = encode(RecordedTicks{{tick}});
        EXPECT_EQ(numberAt<uint32_t>(bytes, 104), 1u << bit);
        const RecordedTick read = std::get<RecordedTicks>(decode(4, bytes)).ticks[0];
        EXPECT_EQ(read.sample.valid, bit == 0);
        EXPECT_EQ(read.late, bit == 1);
        EXPECT_EQ(read.missed, bit == 2);
        EXPECT_EQ(read.checkpoint, bit == 3);
        EXPECT_EQ(read.sample.begins, bit == 4);
        EXPECT_EQ(read.sample.inSight, bit == 5);
    }
}

TEST(RecordingFormat, RefusesChoicesBeyondTheLastAndTakesTheLast) {
    for (const auto& info : settingFields()) {
        if (info.words.empty())
            continue;
        const auto choices = static_cast<double>(info.words.size());
        const std::vector<std::byte> last = settingsWith(std::string(info.name), choices - 1.0),
                                     beyond = settingsWith(std::string(info.name), choices);
        ByteReader good(last), bad(beyond);
        EXPECT_NO_THROW((void)getSettings(good)) << info.name;
        EXPECT_THROW((void)getSettings(bad), Error) << info.name;
    }
}

} // namespace
} // namespace touchstone

// Devices that are not there: hidapi, our I/O thread and the mailbox against umockdev, packet by packet.

#include "devices/hid/hid_device.h"
#include "devices/hid/raw_report.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/device_commands.h"
#include "tests/support/eventually.h"
#include "tests/support/mock_hid.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <random>
#include <thread>

namespace touchstone {
namespace {

using test::Bytes;
using test::command;
using test::eventually;
using test::MockBus;
using test::MockHid;
using test::MockHidInfo;

const MockHidInfo kNavigator{
    .vendor = 0x046d, .product = 0xc626, .name = "SpaceNavigator", .usagePage = 1, .usage = 8};
const MockHidInfo kWooden{.vendor = 0x16c0, .product = 0x0486, .name = "Polhem"};
const MockHidInfo kDiy{.vendor = 0x1209, .product = 0x0001, .name = "DIY"};

HidRecipe recipe(const char* file, const std::string& path = {}) {
    return recipeOf(readDeviceFile(std::string(TOUCHSTONE_SOURCE "/devices/files/") + file), path);
}

HidRecipe navigator(const std::string& path = {}) {
    HidNode node;
    node.vendor = 0x046d;
    node.product = 0xc626;
    node.path = path;
    node.known = knownHid(0x046d, 0xc626);
    return spaceMouseRecipe(node);
}

bool connected(const HidDevice& device) {
    return device.report().state == LinkState::Connected;
}

Bytes bytes(const std::array<uint8_t, kRawReportSize>& report) {
    return {report.begin(), report.end()};
}
Bytes place(uint32_t sequence, const glm::dvec3& metres) {
    RawState state{.flags = kRawHomed, .sequence = sequence};
    for (int i = 0; i < 3; ++i)
        state.axes[static_cast<size_t>(i)] = static_cast<int32_t>(std::lround(1e9 * metres[i]));
    return bytes(rawState(state));
}
/// What a raw device heard last.
RawCommand lastCommand(const MockHid& mock) {
    const Bytes heard = mock.lastHeard();
    const auto parsed = heard.size() == 65 ? parseRawCommand(std::span(heard).subspan(1)) : std::nullopt;
    return parsed.value_or(RawCommand{.kind = 0});
}

TEST(HidDevice, ASpaceMouseIsReadPacketByPacket) {
    MockBus bus;
    const auto mouse = bus.plug(kNavigator);
    HidDevice device(navigator());
    ASSERT_TRUE(eventually([&] { return connected(device); })) << device.report().problem;
    EXPECT_EQ(device.report().where, mouse->node());
    mouse->say({1, 0x5E, 0x01, 0, 0, 0, 0}); // 350 to the right
    mouse->say({2, 0, 0, 0, 0, 0, 0});
    mouse->say({1, 0x5E, 0x01, 0, 0});          // short
    mouse->say({1, 0x5E, 0x01, 0, 0, 0, 0, 0}); // long
    mouse->say({23, 88});                       // the battery
    mouse->say({3, 1});
    ASSERT_TRUE(eventually([&] { return device.report().reports == 3; }));
    const LinkReport report = device.report();
    EXPECT_EQ(report.malformed, 2u);
    EXPECT_EQ(report.ignored, 1u);
    double time = 0.0;
    DeviceSample sample;
    EXPECT_TRUE(eventually([&] {
        const double begin = sample.position.x;
        mouse->say({1, 0x5E, 0x01, 0, 0, 0, 0}); // still pushed: what is old by now moves nothing
        for (int i = 0; i < 50; ++i)
            sample = device.sample(time += 1e-3);
        return sample.position.x > begin + 1e-3;
    }));
    EXPECT_TRUE(sample.valid);
    EXPECT_EQ(sample.buttons, 1u);
    EXPECT_EQ(sample.position.y, 0.0);
    // Seen from the left, where the screen's right is the workspace's z.
    device.face(glm::angleAxis(glm::radians(-90.0), glm::dvec3(0.0, 1.0, 0.0)));
    for (int i = 0; i < 200; ++i) // the speed turns with the view
        (void)device.sample(time += 1e-3);
    const glm::dvec3 before = device.sample(time += 1e-3).position;
    ASSERT_TRUE(eventually([&] {
        mouse->say({1, 0x5E, 0x01, 0, 0, 0, 0}); // still pushed
        const glm::dvec3 moved = device.sample(time += 1e-3).position - before;
        return moved.z > 1e-3 && std::abs(moved.x) < 1e-2 * moved.z;
    }));
    EXPECT_TRUE(mouse->heard().empty()) << "a SpaceMouse takes nothing";
}

TEST(HidDevice, SilenceIsRestOnlyOfACapAtRest) {
    MockBus bus;
    const auto mouse = bus.plug(kNavigator);
    HidDevice device(navigator());
    ASSERT_TRUE(eventually([&] { return connected(device); }));
    const double stale = device.limits().staleAge;
    std::this_thread::sleep_for(std::chrono::duration<double>(2.0 * stale));
    EXPECT_TRUE(eventually([&] { return device.sample(0.0).age < stale; })) << "at rest it says nothing";
    mouse->say({1, 100, 0, 0, 0, 0, 0});
    ASSERT_TRUE(eventually([&] { return device.report().reports == 1; }));
    std::this_thread::sleep_for(std::chrono::duration<double>(1.5 * stale));
    const DeviceSample sample = device.sample(1.0);
    EXPECT_GT(sample.age, stale) << "pushed and silent: nobody knows how far by now";
    EXPECT_TRUE(sample.valid);
    mouse->say({1, 0, 0, 0, 0, 0, 0});
    EXPECT_TRUE(eventually([&] { return device.sample(1.0).age < stale; }));
}

TEST(HidDevice, AWoodenHapticsIsSpokenToFirstThenReadThenDriven) {
    MockBus bus;
    const auto wooden = bus.plug(kWooden);
    auto device = std::make_unique<HidDevice>(recipe("woodenhaptics.json"));
    const Bytes nothing(15, 0);
    ASSERT_TRUE(eventually([&] { return wooden->lastHeard() == nothing; })) << "its firmware waits for that";
    EXPECT_FALSE(device->sample(0.0).valid);
    wooden->say({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});    // short
    wooden->say({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}); // arm up, forearm down
    ASSERT_TRUE(eventually([&] { return device->sample(0.0).valid; }));
    EXPECT_NEAR(glm::length(device->sample(0.0).position - glm::dvec3(0.0, -0.04, -0.22)), 0.0, 1e-12);
    EXPECT_EQ(device->report().malformed, 1u);
    // 1 N along x (the base's y) has no lever at home; 1 N towards the user leans on both links:
    // (0.205, 0.245) N·m over 12 and 0.0259 N·m/A, against the turn of the motors.
    const Bytes expected{0, 0, 0, 0x6D, 0xFD, 0xEC, 0xFC, 0, 0, 0, 0, 0, 0, 0, 0}; // -659, -788 mA
    ASSERT_TRUE(eventually([&] {
        device->apply(command({0.0, 0.0, 1.0}));
        return wooden->lastHeard() == expected;
    })) << testing::PrintToString(wooden->lastHeard());
    // The servo falls silent: zero, without being asked.
    ASSERT_TRUE(eventually([&] { return wooden->lastHeard() == nothing; }));
    ASSERT_TRUE(eventually([&] {
        device->apply(command({0.0, 0.0, 1.0}));
        return wooden->lastHeard() == expected;
    }));
    device.reset();
    EXPECT_EQ(wooden->lastHeard(), nothing) << "the last word is zero";
}

TEST(HidDevice, ARawDeviceSendsPlacesAndGetsForces) {
    MockBus bus;
    const auto diy = bus.plug(kDiy);
    HidDevice device(recipe("diy_position.json"));
    ASSERT_TRUE(eventually([&] { return connected(device); }));
    diy->say(place(1, {0.01, -0.02, 0.03}));
    ASSERT_TRUE(eventually([&] { return device.sample(0.0).valid; }));
    EXPECT_NEAR(glm::length(device.sample(0.0).position - glm::dvec3(0.01, -0.02, 0.03)), 0.0, 1e-9);
    ASSERT_TRUE(eventually([&] {
        device.apply(command({1.0, -2.0, 0.5}));
        return lastCommand(*diy).values[0] == 1'000'000;
    }));
    EXPECT_EQ(lastCommand(*diy).values[1], -2'000'000);
    EXPECT_EQ(lastCommand(*diy).answers, 1u);
    EXPECT_EQ(lastCommand(*diy).watchdogMs, 20);
    ASSERT_TRUE(eventually([&] { return lastCommand(*diy).values == (std::array<int32_t, 6>{}); }))
        << "silent servo";
    const auto pushing = [&] {
        device.apply(command({1.0, -2.0, 0.5}));
        return lastCommand(*diy).values[0] == 1'000'000;
    };
    ASSERT_TRUE(eventually(pushing));
    device.letGo();
    ASSERT_TRUE(eventually([&] { return !pushing(); })) << "whatever the servo still says";
    device.takeUp();
    ASSERT_TRUE(eventually(pushing));
}

TEST(HidDevice, OnlyFreshWordsMakeASampleYounger) {
    MockBus bus;
    const auto diy = bus.plug(kDiy);
    HidDevice device(recipe("diy_position.json"));
    ASSERT_TRUE(eventually([&] { return connected(device); }));
    diy->say(place(7, {0.01, 0.0, 0.0}));
    ASSERT_TRUE(eventually([&] { return device.report().reports == 1; }));
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < 20; ++i) { // a firmware that hangs says the same again and again
        diy->say(place(7, {0.01, 0.0, 0.0}));
        Bytes broken = place(8, {5.0, 0.0, 0.0});
        broken[21] ^= 0x10;
        diy->say(broken);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    ASSERT_TRUE(eventually([&] { return device.report().repeated + device.report().malformed == 40; }));
    const double since = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const DeviceSample sample = device.sample(0.0);
    EXPECT_GE(sample.age, since);
    EXPECT_EQ(sample.position.x, 0.01);
    EXPECT_EQ(device.report().repeated, 20u);
    diy->say(place(12, {0.02, 0.0, 0.0}));
    ASSERT_TRUE(eventually([&] { return device.sample(0.0).position.x == 0.02; }));
    EXPECT_EQ(device.report().lost, 4u);
}

TEST(HidDevice, PluggedInLateUnpluggedAndPluggedInElsewhere) {
    MockBus bus;
    HidDevice device(recipe("diy_position.json"));
    ASSERT_TRUE(eventually([&] { return !device.report().problem.empty(); }));
    EXPECT_EQ(device.report().state, LinkState::Searching);
    EXPECT_FALSE(device.sample(0.0).valid);
    for (uint64_t round = 1; round <= 3; ++round) {
        const auto diy = bus.plug(kDiy); // each time at another node
        ASSERT_TRUE(eventually([&] { return connected(device) && device.report().connects == round; }))
            << device.report().problem;
        EXPECT_EQ(device.report().where, diy->node());
        EXPECT_FALSE(device.sample(0.0).valid) << "what the last connection said no longer holds";
        diy->say(place(static_cast<uint32_t>(round), {0.01 * static_cast<double>(round), 0.0, 0.0}));
        ASSERT_TRUE(eventually([&] { return device.sample(0.0).valid; }));
        EXPECT_NEAR(device.sample(0.0).position.x, 0.01 * static_cast<double>(round), 1e-9);
        ASSERT_TRUE(eventually([&] {
            device.apply(command({1.0, 0.0, 0.0}));
            return lastCommand(*diy).values[0] == 1'000'000;
        }));
        diy->unplug();
        ASSERT_TRUE(eventually([&] { return !device.sample(0.0).valid; })) << "unplugged in contact";
        ASSERT_TRUE(eventually([&] { return device.report().state == LinkState::Searching; }));
        EXPECT_NE(device.report().problem.find("unplugged"), std::string::npos);
        device.apply(command({1.0, 0.0, 0.0})); // the servo ramps out
    }
}

TEST(HidDevice, AnotherBoardWithTheSameIdsDoesNotTakeItsPlace) {
    MockBus bus;
    HidDevice device(recipe("diy_position.json"));
    auto first = bus.plug(kDiy);
    ASSERT_TRUE(eventually([&] { return connected(device); }));
    MockHidInfo other = kDiy;
    other.name = "Somebody else's experiment";
    const auto stranger = bus.plug(other);
    first->unplug();
    ASSERT_TRUE(eventually([&] {
        return device.report().problem.find("not plugged in") != std::string::npos;
    })) << "it has looked, and the stranger was there";
    first = bus.plug(kDiy);
    ASSERT_TRUE(eventually([&] { return connected(device); }));
    EXPECT_EQ(device.report().where, first->node());
    EXPECT_TRUE(stranger->heard().empty());
}

TEST(HidDevice, TwoDevicesAtOnceEachWithItsOwnReports) {
    MockBus bus;
    const auto left = bus.plug(kDiy), right = bus.plug(kDiy); // alike, without serial numbers
    const auto mouse = bus.plug(kNavigator);
    HidDevice second(recipe("diy_position.json", right->node()));
    ASSERT_TRUE(eventually([&] { return connected(second); }));
    HidDevice first(recipe("diy_position.json"));
    HidDevice third(navigator());
    ASSERT_TRUE(eventually([&] { return connected(first) && connected(third); }));
    EXPECT_EQ(first.report().where, left->node());
    EXPECT_EQ(second.report().where, right->node());
    for (uint32_t i = 1; i <= 100; ++i) {
        left->say(place(i, {1e-4 * i, 0.0, 0.0}));
        right->say(place(i, {0.0, 2e-4 * i, 0.0}));
        mouse->say({1, 0, 0, 0x5E, 0x01, 0, 0});
    }
    ASSERT_TRUE(eventually([&] {
        return first.report().reports == 100 && second.report().reports == 100 &&
               third.report().reports == 100;
    }));
    EXPECT_NEAR(glm::length(first.sample(0.0).position - glm::dvec3(0.01, 0.0, 0.0)), 0.0, 1e-9);
    EXPECT_NEAR(glm::length(second.sample(0.0).position - glm::dvec3(0.0, 0.02, 0.0)), 0.0, 1e-9);
    ASSERT_TRUE(eventually([&] {
        first.apply(command({1.0, 0.0, 0.0}));
        second.apply(command({0.0, 3.0, 0.0}));
        return lastCommand(*left).values[0] == 1'000'000 && lastCommand(*right).values[1] == 3'000'000;
    }));
}

TEST(HidDevice, ADeviceWithoutPermissionSaysWhatToDo) {
    MockBus bus;
    MockHidInfo locked = kDiy;
    locked.mode = 0;
    const auto diy = bus.plug(locked);
    const bool root = ::geteuid() == 0;
    // Root may do everything whatever the permissions say: be somebody else for a while.
    constexpr uid_t kNobody = 65534;
    ASSERT_TRUE(!root || setresuid(kNobody, kNobody, 0) == 0);
    {
        HidDevice device(recipe("diy_position.json"));
        EXPECT_TRUE(eventually([&] { return device.report().state == LinkState::Refused; }));
        EXPECT_NE(device.report().problem.find("ATTRS{idVendor}==\"1209\""), std::string::npos)
            << device.report().problem;
        EXPECT_FALSE(device.sample(0.0).valid);
        const auto nodes = listHidNodes();
        ASSERT_EQ(nodes.size(), 1u) << "listed all the same";
        EXPECT_EQ(nodes[0].access, HidAccess::None);
    }
    ASSERT_TRUE(!root || setresuid(0, 0, 0) == 0);
}

TEST(HidDevice, ADeviceThatTakesNoCommandsIsNotDriven) {
    MockBus bus;
    const auto diy = bus.plug(kDiy);
    diy->refuseWrites(true);
    HidDevice device(recipe("diy_position.json"));
    diy->say(place(1, {}));
    ASSERT_TRUE(eventually([&] {
        device.apply(command({1.0, 0.0, 0.0}));
        return device.report().problem.find("takes no commands") != std::string::npos;
    }));
    EXPECT_FALSE(device.sample(0.0).valid);
    EXPECT_GE(device.report().sendFailures, 20u);
    diy->refuseWrites(false);
    ASSERT_TRUE(eventually([&] {
        diy->say(place(static_cast<uint32_t>(device.report().reports) + 2, {}));
        return device.sample(0.0).valid;
    })) << "and is tried again";
}

TEST(HidDevice, EveryPacketOfAStormIsCounted) {
    MockBus bus;
    const auto diy = bus.plug(kDiy);
    HidDevice device(recipe("diy_position.json"));
    ASSERT_TRUE(eventually([&] { return connected(device); }));
    std::mt19937_64 random(12);
    constexpr uint32_t kPackets = 3000;
    uint32_t good = 0;
    for (uint32_t i = 0; i < kPackets; ++i) {
        Bytes report = place(i + 1, {1e-5 * i, 0.0, 0.0});
        if (random() % 3 == 0) {
            report.resize(1 + random() % 63);
        } else if (random() % 3 == 0) {
            report[random() % 64] ^= static_cast<uint8_t>(1 + random() % 255);
        } else {
            ++good;
        }
        diy->say(report);
    }
    ASSERT_TRUE(eventually([&] {
        const LinkReport report = device.report();
        return report.reports + report.malformed == kPackets;
    }));
    EXPECT_EQ(device.report().reports, good);
    EXPECT_EQ(device.report().connects, 1u);
}

TEST(HidDevice, TheServosSideAllocatesNothing) {
    MockBus bus;
    const auto mouse = bus.plug(kNavigator);
    const auto diy = bus.plug(kDiy);
    HidDevice pushed(navigator()), driven(recipe("diy_position.json"));
    ASSERT_TRUE(eventually([&] { return connected(pushed) && connected(driven); }));
    const DeviceCommand push = command({1.0, 0.0, 0.0});
    const uint64_t before = test::allocationsOnThisThread();
    double sum = 0.0;
    for (int i = 0; i < 1000; ++i) {
        sum += pushed.sample(1e-3 * i).age + driven.sample(1e-3 * i).age;
        driven.apply(push);
        pushed.apply(push);
    }
    EXPECT_EQ(test::allocationsOnThisThread() - before, 0u) << sum;
}

TEST(HidDevice, ASpaceMouseIsFoundByItsAxesNotByItsKeys) {
    MockHidInfo keys = kNavigator;
    keys.usage = 6; // a keyboard
    MockBus bus;
    const auto keyboard = bus.plug(keys), axes = bus.plug(kNavigator);
    HidDevice device(navigator());
    ASSERT_TRUE(eventually([&] { return connected(device); }));
    EXPECT_EQ(device.report().where, axes->node());
}

} // namespace
} // namespace touchstone

int main(int argc, char** argv) {
    touchstone::test::enterMockEnvironment(argv);
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}

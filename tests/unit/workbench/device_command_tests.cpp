// `devices` and `run --device` with HID devices that are not there, and with another program as the device.

#include "devices/hid/raw_report.h"
#include "tests/support/eventually.h"
#include "tests/support/mock_hid.h"
#include "tests/support/program.h"
#include "tests/unit/workbench/touch_files.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

namespace touchstone::test {
namespace {

const std::string kProgram = TOUCHSTONE_BINARY;
const std::string kSphere = TOUCHSTONE_ASSETS "/table1_object4.glb"; // fitted: 75 mm of radius
const MockHidInfo kNavigator{
    .vendor = 0x046d, .product = 0xc626, .name = "SpaceNavigator", .usagePage = 1, .usage = 8};
const MockHidInfo kDiy{.vendor = 0x1209, .product = 0x0001, .name = "DIY"};

Bytes place(uint32_t sequence, double x, double y, double z) {
    const auto nanometres = [](double metres) { return static_cast<int32_t>(std::lround(1e9 * metres)); };
    const auto state = rawState({.flags = kRawHomed,
                                 .sequence = sequence,
                                 .axes = {nanometres(x), nanometres(y), nanometres(z), 0, 0, 0}});
    return {state.begin(), state.end()};
}

/// The largest force that a raw device was told, N.
double largestHeard(const MockHid& mock) {
    double largest = 0.0;
    for (const Bytes& heard : mock.heard()) {
        const auto command = parseRawCommand(std::span(heard).subspan(1));
        EXPECT_TRUE(command) << "a command that the device's firmware would refuse";
        for (int i = 0; command && i < 3; ++i)
            largest = std::max(largest, 1e-6 * std::abs(command->values[static_cast<size_t>(i)]));
    }
    return largest;
}

/// What a raw device was told last.
std::array<int32_t, 6> lastValues(const MockHid& mock) {
    const Bytes heard = mock.lastHeard();
    const auto command = heard.size() == 65 ? parseRawCommand(std::span(heard).subspan(1)) : std::nullopt;
    return command ? command->values : std::array<int32_t, 6>{-1};
}

/// A device's firmware: says where it is a thousand times a second, until told to stop.
class Firmware {
  public:
    /// `path`: where the device is after so many seconds.
    Firmware(MockHid& mock, std::function<glm::dvec3(double)> path)
        : thread_([this, &mock, path = std::move(path)] {
              const auto start = std::chrono::steady_clock::now();
              for (uint32_t i = 1; !stop_; ++i) {
                  const glm::dvec3 at = path(1e-3 * i);
                  mock.trySay(place(i, at.x, at.y, at.z));
                  std::this_thread::sleep_until(start + std::chrono::milliseconds(i));
              }
          }) {}
    ~Firmware() {
        stop_ = true;
        thread_.join();
    }
    Firmware(const Firmware&) = delete;
    Firmware& operator=(const Firmware&) = delete;

  private:
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

TEST(DevicesCommand, ListsWhatIsThereWhatItIsForAndHowToUseIt) {
    MockBus bus;
    const auto mouse = bus.plug(kNavigator), diy = bus.plug(kDiy);
    const auto teensy = bus.plug({.vendor = 0x16c0, .product = 0x0486, .name = "My experiment"});
    const auto keyboard = bus.plug({.vendor = 0x1234, .product = 0x5678, .name = "Keys"});
    const ProgramResult result = runProgram({kProgram, "devices"});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto line = [&](const std::string& node) {
        const size_t begin = result.out.find(node + " ");
        return begin == std::string::npos ? ""
                                          : result.out.substr(begin, result.out.find('\n', begin) - begin);
    };
    EXPECT_NE(line(mouse->node()).find("SpaceNavigator  ready  --device /dev/hidraw0  (input only)"),
              std::string::npos)
        << result.out;
    EXPECT_NE(line(diy->node()).find("ready  --device /dev/hidraw1  (gives force)"), std::string::npos)
        << result.out;
    EXPECT_NE(line(teensy->node()).find("choose it only if it is one"), std::string::npos) << result.out;
    EXPECT_NE(line(keyboard->node()).find("not a device that Touchstone knows"), std::string::npos)
        << result.out;
}

TEST(DevicesCommand, TestReportsWhatComesAndSendsNoForce) {
    MockBus bus;
    const ScratchFolder scratch;
    const std::string json = (scratch / "t.json").string();
    const auto diy = bus.plug(kDiy);
    diy->say(Bytes(64, 9)); // malformed
    ProgramResult result;
    {
        const Firmware firmware(*diy, [](double t) { return glm::dvec3(0.01 * std::sin(t), 0.0, 0.02); });
        result = runProgram({kProgram, "devices", "--test", "DIY device", "--seconds", "1", "--json", json});
    }
    ASSERT_EQ(result.status, 0) << result.err << result.out;
    EXPECT_NE(result.out.find("connected at /dev/hidraw0"), std::string::npos) << result.out;
    const auto figures = nlohmann::json::parse(readFile(json));
    EXPECT_GT(figures["link"]["reports"], 50);
    EXPECT_EQ(figures["link"]["malformed"], 1);
    EXPECT_GT(figures["valid_ticks"], 50);
    EXPECT_NEAR(figures["last"][2], 0.02, 1e-9);
    EXPECT_EQ(figures["force_n"], 0.0);
    EXPECT_GT(diy->heard().size(), 0u) << "it is kept alive";
    EXPECT_EQ(largestHeard(*diy), 0.0);
}

TEST(DevicesCommand, TestPushesOnlyAsHardAsItIsAsked) {
    MockBus bus;
    const auto diy = bus.plug(kDiy);
    {
        const Firmware firmware(*diy, [](double) { return glm::dvec3(0.0); });
        const ProgramResult result =
            runProgram({kProgram, "devices", "--test", diy->node(), "--seconds", "3", "--force", "0.5"});
        ASSERT_EQ(result.status, 0) << result.err;
    }
    EXPECT_LE(largestHeard(*diy), 0.5);
    EXPECT_GT(largestHeard(*diy), 0.3);
    EXPECT_EQ(lastValues(*diy), (std::array<int32_t, 6>{})) << "the last word is zero";
    EXPECT_EQ(runProgram({kProgram, "devices", "--test", diy->node(), "--force", "5"}).status, 2);
    EXPECT_EQ(runProgram({kProgram, "devices", "--force", "1"}).status, 2) << "without a device to test";
}

TEST(DevicesCommand, ADeviceThatIsNotThereIsSaidSo) {
    const MockBus bus;
    const ProgramResult described = runProgram({kProgram, "devices", "--test", "gantry", "--seconds", "0.2"});
    EXPECT_EQ(described.status, 1);
    EXPECT_NE(described.out.find("not plugged in"), std::string::npos) << described.out;
    for (const char* name :
         {"nothing of that name", "/dev/hidraw7", "/nowhere/file.json", "udp:0", "udp:192.168.1.1:99"}) {
        const ProgramResult result = runProgram({kProgram, "devices", "--test", name});
        EXPECT_EQ(result.status, 1) << name;
        EXPECT_FALSE(result.err.empty()) << name;
    }
}

/// Unplugged while it pushes, plugged in again elsewhere: the force stays within the limits of the device's
/// file all the while, fades out, and comes back.
TEST(RunWithDevice, UnpluggedInContactAndPluggedInAgain) {
    MockBus bus;
    const ScratchFolder scratch;
    std::string file = readFile(TOUCHSTONE_SOURCE "/devices/files/diy_position.json");
    const std::string limit = "\"maxForce\": 3.0";
    file.replace(file.find(limit), limit.size(), "\"maxForce\": 1.5, \"maxForceRate\": 100");
    writeTextFile(scratch / "slow.json", file);
    const std::string json = (scratch / "r.json").string(), csv = (scratch / "t.csv").string();
    auto diy = bus.plug(kDiy);
    // In and out of the sphere of 75 mm: who starts inside feels nothing until outside.
    const auto pressing = [](double t) { return glm::dvec3(0.0, 0.08 + 0.012 * std::cos(6.0 * t), 0.0); };
    const auto pressed = [](const MockHid& mock) {
        return [&mock] {
            return lastValues(mock)[1] > 500'000; // pushed up by more than half a newton
        };
    };
    auto firmware = std::make_unique<Firmware>(*diy, pressing);
    BackgroundProgram program({kProgram, "run", kSphere, "--headless", "--rate", "250", "--seconds", "600",
                               "--size", "160x90", "--device", (scratch / "slow.json").string(), "--json",
                               json, "--record-ticks", csv, "--set", "friction=off"},
                              {}, scratch / "log");
    ASSERT_TRUE(eventually(pressed(*diy))) << readFile(scratch / "log");
    firmware.reset();
    diy->unplug();
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    auto again = bus.plug(kDiy);
    firmware = std::make_unique<Firmware>(*again, pressing);
    ASSERT_TRUE(eventually(pressed(*again))) << readFile(scratch / "log");
    ASSERT_EQ(program.stop(), 0) << readFile(scratch / "log");
    firmware.reset();

    const auto figures = nlohmann::json::parse(readFile(json));
    EXPECT_EQ(figures["device"], "DIY device");
    EXPECT_EQ(figures["link"]["connects"], 2);
    EXPECT_EQ(figures["link"]["malformed"], 0);
    EXPECT_EQ(figures["allocations_in_tick"], 0);
    EXPECT_EQ(figures["flags"]["force_fault"], 0);
    EXPECT_GT(figures["flags"]["input_invalid"], 50);
    EXPECT_LE(std::max(largestHeard(*diy), largestHeard(*again)), 1.5);
    const Table ticks = readTable(csv);
    bool pushedBefore = false, faded = false, pushedAfter = false;
    for (size_t i = 1; i < ticks.rows; ++i) {
        glm::dvec3 now, before;
        for (int axis = 0; axis < 3; ++axis) {
            const std::string column = std::string("command_") + "xyz"[axis];
            now[axis] = ticks[column][i];
            before[axis] = ticks[column][i - 1];
        }
        ASSERT_LE(glm::length(now), 1.5);
        const double dt = ticks["t"][i] - ticks["t"][i - 1];
        ASSERT_LE(glm::length(now - before), 100.0 * dt * (1.0 + 1e-9) + 1e-12) << "tick " << i;
        pushedBefore |= now.y > 0.5;
        faded |= pushedBefore && now == glm::dvec3(0.0);
        pushedAfter |= faded && now.y > 0.5;
    }
    EXPECT_TRUE(pushedBefore && faded && pushedAfter);
    EXPECT_EQ(lastValues(*again), (std::array<int32_t, 6>{})) << "the last word is zero";
}

/// Two devices of different limits; one is unplugged in contact: its force is gone, the other's goes on.
TEST(RunWithDevice, OfTwoOneVanishes) {
    MockBus bus;
    const ScratchFolder scratch;
    std::string file = readFile(TOUCHSTONE_SOURCE "/devices/files/diy_position.json");
    const auto limited = [&](const std::string& name, const std::string& force, const std::string& product) {
        std::string own = file;
        for (const auto& [from, to] :
             {std::pair<std::string, std::string>{"\"maxForce\": 3.0", "\"maxForce\": " + force},
              {"\"0001\"", "\"" + product + "\""}})
            if (const size_t at = own.find(from); at != std::string::npos)
                own.replace(at, from.size(), to);
        writeTextFile(scratch / name, own);
        return (scratch / name).string();
    };
    const std::string strong = limited("strong.json", "2.0", "0001"),
                      weak = limited("weak.json", "0.75", "0002");
    MockHidInfo other = kDiy;
    other.product = 0x0002;
    const std::string json = (scratch / "r.json").string(), recording = (scratch / "r.tsrec").string();
    auto one = bus.plug(kDiy);
    auto two = bus.plug(other);
    const auto pressing = [](double t) { return glm::dvec3(0.0, 0.08 + 0.012 * std::cos(6.0 * t), 0.0); };
    auto first = std::make_unique<Firmware>(*one, pressing);
    auto second = std::make_unique<Firmware>(*two, pressing);
    BackgroundProgram program({kProgram,   "run",       kSphere,    "--headless", "--rate",
                               "250",      "--seconds", "600",      "--size",     "160x90",
                               "--device", strong,      "--device", weak,         "--json",
                               json,       "--record",  recording,  "--set",      "friction=off"},
                              {}, scratch / "log");
    const auto pushed = [](const MockHid& mock) { return lastValues(mock)[1] > 300'000; };
    ASSERT_TRUE(eventually([&] { return pushed(*one); })) << readFile(scratch / "log");
    ASSERT_TRUE(eventually([&] { return pushed(*two); })) << readFile(scratch / "log");
    second.reset();
    two->unplug();
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    ASSERT_TRUE(eventually([&] { return lastValues(*one)[1] == 0; })); // in the air
    ASSERT_TRUE(eventually([&] { return pushed(*one); })) << "the other one goes on touching";
    ASSERT_EQ(program.stop(), 0) << readFile(scratch / "log");
    first.reset();
    EXPECT_LE(largestHeard(*one), 2.0);
    EXPECT_GT(largestHeard(*one), 0.75);
    EXPECT_LE(largestHeard(*two), 0.75);
    const auto figures = nlohmann::json::parse(readFile(json));
    ASSERT_EQ(figures["hands"].size(), 2u);
    EXPECT_EQ(figures["hands"][0]["flags"]["force_fault"], 0);
    EXPECT_LT(figures["hands"][0]["flags"]["input_invalid"], figures["hands"][1]["flags"]["input_invalid"]);
    EXPECT_EQ(figures["allocations_in_tick"], 0);
    const ProgramResult replay = runProgram({kProgram, "replay", recording});
    EXPECT_EQ(replay.status, 0) << replay.out << replay.err;
}

/// A port that nobody has.
std::string freePort() {
    const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof address;
    EXPECT_EQ(::bind(socket, reinterpret_cast<sockaddr*>(&address), length), 0);
    EXPECT_EQ(::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &length), 0);
    ::close(socket);
    return std::to_string(ntohs(address.sin_port));
}

TEST(RunWithDevice, TheExampleInPythonFeelsTheModel) {
    const MockBus bus;
    const ScratchFolder scratch;
    const std::string json = (scratch / "r.json").string(), port = freePort();
    BackgroundProgram program({kProgram, "run", kSphere, "--headless", "--rate", "250", "--seconds", "600",
                               "--size", "160x90", "--device", "udp:" + port, "--json", json},
                              {}, scratch / "log");
    ASSERT_TRUE(eventually([&] { return readFile(scratch / "log").find(port) != std::string::npos; }));
    const ProgramResult client = runProgram(
        {"python3", TOUCHSTONE_SOURCE "/examples/external_device.py", "--port", port, "--seconds", "7"});
    ASSERT_EQ(client.status, 0) << client.err;
    ASSERT_EQ(program.stop(), 0) << readFile(scratch / "log");
    const auto figures = nlohmann::json::parse(readFile(json));
    EXPECT_GT(figures["link"]["reports"], 100);
    EXPECT_EQ(figures["link"]["malformed"], 0);
    EXPECT_GT(figures["contact"]["ticks"], 100);
    EXPECT_NE(client.out.find("(0 malformed)"), std::string::npos) << client.out;
    EXPECT_EQ(client.out.find("heard 0 forces"), std::string::npos) << client.out;
}

} // namespace
} // namespace touchstone::test

int main(int argc, char** argv) {
    touchstone::test::enterMockEnvironment(argv);
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}

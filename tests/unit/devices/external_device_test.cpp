// A device that is another program, by real sockets on the loopback.

#include "devices/external/external_device.h"
#include "engine/core/error.h"
#include "haptics/safety/location_limiter.h"
#include "tests/support/device_commands.h"
#include "tests/support/eventually.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <random>
#include <thread>

namespace touchstone {
namespace {

using test::command, test::eventually;

using Bytes = std::vector<uint8_t>;

/// A program that speaks with the device.
class Client {
  public:
    explicit Client(uint16_t port) : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        to.sin_port = htons(port);
        EXPECT_EQ(::connect(socket_, reinterpret_cast<sockaddr*>(&to), sizeof to), 0);
    }
    ~Client() { ::close(socket_); }
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    void say(std::span<const uint8_t> bytes) { (void)!::send(socket_, bytes.data(), bytes.size(), 0); }
    void sayPlace(uint32_t sequence, const glm::dvec3& position, uint32_t buttons = 0) {
        say(placePacket({.sequence = sequence, .buttons = buttons, .position = position}));
    }
    /// The newest force that has come; waits for one.
    std::optional<ForcePacket> force() { return newest<ForcePacket>(parseForcePacket); }
    std::optional<LocationPacket> location() { return newest<LocationPacket>(parseLocationPacket); }

  private:
    template <class Packet>
    std::optional<Packet> newest(std::optional<Packet> (*parse)(std::span<const uint8_t>)) {
        std::optional<Packet> newest;
        pollfd waiting{socket_, POLLIN, 0};
        while (::poll(&waiting, 1, newest ? 0 : 2000) > 0) {
            std::array<uint8_t, 256> bytes;
            const ssize_t size = ::recv(socket_, bytes.data(), bytes.size(), 0);
            if (size < 0)
                break;
            if (const auto packet = parse(std::span(bytes).first(static_cast<size_t>(size))))
                newest = packet;
        }
        return newest;
    }

    int socket_;
};

TEST(ExternalPacket, HasTheDocumentedBytes) {
    const auto place = placePacket({.sequence = 0x04030201,
                                    .buttons = 5,
                                    .position = {1.0, -2.0, 0.0},
                                    .orientation = glm::dquat(0.0, 0.0, 1.0, 0.0)});
    const Bytes expected{'T', 'S', 'X', 'P', 1, 0, 72,   0,    1, 2, 3, 4, 5, 0, 0, 0, //
                         0,   0,   0,   0,   0, 0, 0xF0, 0x3F,                         // 1
                         0,   0,   0,   0,   0, 0, 0,    0xC0,                         // -2
                         0,   0,   0,   0,   0, 0, 0,    0,                            // 0
                         0,   0,   0,   0,   0, 0, 0,    0,                            // w
                         0,   0,   0,   0,   0, 0, 0,    0,                            // x
                         0,   0,   0,   0,   0, 0, 0xF0, 0x3F,                         // y
                         0,   0,   0,   0,   0, 0, 0,    0};                           // z
    EXPECT_EQ(Bytes(place.begin(), place.end()), expected);
    const auto back = parsePlacePacket(place);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->position, glm::dvec3(1.0, -2.0, 0.0));
    EXPECT_EQ(back->orientation.y, 1.0);

    const auto force = forcePacket({.sequence = 7, .answers = 8, .force = {0.0, 1.0, 0.0}});
    EXPECT_EQ(force.size(), 64u);
    EXPECT_EQ(std::string(force.begin(), force.begin() + 4), "TSXF");
    EXPECT_EQ(force[6], 64);
    EXPECT_EQ(force[8], 7);
    EXPECT_EQ(force[12], 8);
    EXPECT_EQ(force[16 + 8 + 7], 0x3F);
    EXPECT_EQ(parseForcePacket(force)->force.y, 1.0);
}

TEST(ExternalPacket, WhatCannotBeAPlaceIsRefused) {
    const auto with = [](size_t index, double value) {
        auto bytes = placePacket({});
        const auto bits = std::bit_cast<uint64_t>(value);
        for (size_t i = 0; i < 8; ++i)
            bytes[16 + 8 * index + i] = static_cast<uint8_t>(bits >> 8 * i);
        return parsePlacePacket(bytes);
    };
    ASSERT_TRUE(with(0, 0.1));
    for (size_t i = 0; i < 7; ++i)
        for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), -1e300, 10.1})
            EXPECT_FALSE(with(i, bad)) << i << " " << bad;
    EXPECT_TRUE(with(0, 5e-324)) << "denormal, but a place";
    EXPECT_FALSE(with(4, 1.0)) << "a turn of length 1.4";
    ASSERT_TRUE(with(3, 0.0)) << "no turn given";
    EXPECT_EQ(with(3, 0.0)->orientation, glm::dquat(1.0, 0.0, 0.0, 0.0));
    const auto good = placePacket({});
    for (size_t size = 0; size < good.size(); ++size)
        EXPECT_FALSE(parsePlacePacket(std::span(good).first(size)));
    Bytes longer(good.begin(), good.end());
    longer.push_back(0);
    EXPECT_FALSE(parsePlacePacket(longer));
    for (size_t i = 0; i < 8; ++i) {
        auto head = good;
        head[i] ^= 1;
        EXPECT_FALSE(parsePlacePacket(head)) << i;
    }
}

TEST(ExternalPacket, NoiseNeverBecomesAPlaceThatIsNone) {
    std::mt19937_64 random(5);
    int places = 0;
    for (int i = 0; i < 300000; ++i) {
        auto bytes = placePacket({.position = {0.01, 0.02, 0.03}});
        for (int k = 0; k < 4; ++k)
            bytes[random() % bytes.size()] = static_cast<uint8_t>(random());
        if (const auto packet =
                parsePlacePacket(std::span(bytes).first(random() % 10 == 0 ? random() % 72 : 72))) {
            ++places;
            for (int axis = 0; axis < 3; ++axis)
                ASSERT_LE(std::abs(packet->position[axis]), kFarthestPlace);
            ASSERT_NEAR(glm::length(packet->orientation), 1.0, 1e-12);
        }
    }
    EXPECT_GT(places, 1000);
}

TEST(ExternalDevice, TakesPlacesAndGivesForces) {
    ExternalDevice device(0);
    EXPECT_EQ(device.report().state, LinkState::Searching);
    EXPECT_NE(device.report().problem.find(std::to_string(device.port())), std::string::npos);
    EXPECT_FALSE(device.sample(0.0).valid);
    Client client(device.port());
    client.sayPlace(1, {0.01, 0.02, -0.03}, 3);
    ASSERT_TRUE(eventually([&] { return device.sample(0.0).valid; }));
    EXPECT_EQ(device.sample(0.0).position, glm::dvec3(0.01, 0.02, -0.03));
    EXPECT_EQ(device.sample(0.0).buttons, 3u);
    EXPECT_TRUE(eventually([&] { // an order holds for 20 ms only
        device.apply(command({0.5, -1.0, 0.25}));
        const auto force = client.force();
        return force && glm::length(force->force - glm::dvec3(0.5, -1.0, 0.25)) < 1e-12 &&
               force->answers == 1;
    }));
    client.sayPlace(5, {0.0, 0.0, 0.0});
    ASSERT_TRUE(eventually([&] { return device.report().reports == 2; }));
    EXPECT_EQ(device.report().lost, 3u);
}

/// What a device without a servo shows: at once, as far as the pad reaches.
PadCommand padCommand(const glm::dvec2& wanted, const PadLimits& limits) {
    LocationLimiterState state;
    PadCommand command;
    for (int i = 0; i < 1000; ++i)
        command = LocationLimiter::limit(
            {.wanted = wanted, .touching = true, .forceFelt = true, .limits = limits, .dt = 1e-3}, state);
    return command;
}

TEST(ExternalDevice, AClientThatDeclaresAPadHearsTheContactLocation) {
    ExternalDevice device(0);
    Client client(device.port()), other(device.port());
    client.say(padPacket({.sequence = 1, .reach = 0.008, .rate = 0.1}));
    ASSERT_TRUE(eventually([&] { return device.report().ignored == 1; })) << "no client yet";
    client.sayPlace(2, {0.0, 0.0, 0.0});
    ASSERT_TRUE(eventually([&] { return device.sample(0.0).valid; }));
    EXPECT_EQ(device.pad(), PadLimits{});
    device.apply(command({0.5, 0.0, 0.0}));
    EXPECT_TRUE(client.force()) << "and nothing else is sent";
    other.say(padPacket({.sequence = 1, .reach = 0.05, .rate = 1.0}));
    ASSERT_TRUE(eventually([&] { return device.report().ignored == 2; }));
    EXPECT_EQ(device.pad(), PadLimits{});
    client.say(padPacket({.sequence = 3, .reach = 0.008, .rate = 0.1}));
    ASSERT_TRUE(eventually([&] { return device.pad() == PadLimits{0.008, 0.1}; }));
    EXPECT_TRUE(eventually([&] {
        device.applyPad(padCommand({0.003, -0.002}, device.pad()));
        device.apply(command({0.5, 0.0, 0.0}));
        const auto location = client.location();
        return location && location->location == glm::dvec2(0.003, -0.002) && location->answers == 2;
    }));
    // A servo that falls silent leaves the display where it is: nothing jumps to the middle.
    ASSERT_TRUE(eventually([&] {
        const auto force = client.force();
        return force && force->force == glm::dvec3(0.0);
    }));
    const auto last = client.location();
    ASSERT_TRUE(last);
    EXPECT_EQ(last->location, glm::dvec2(0.003, -0.002));
    client.say(padPacket({.sequence = 4, .reach = 0.0, .rate = 0.0}));
    EXPECT_TRUE(eventually([&] { return device.pad().reach == 0.0; }));
}

TEST(ExternalPacket, APadBeyondItsRangeIsRefused) {
    EXPECT_TRUE(parsePadPacket(padPacket({.reach = 0.1, .rate = 100.0})));
    for (const double bad : {std::nan(""), -1e-9, 0.1001, 1e300})
        EXPECT_FALSE(parsePadPacket(padPacket({.reach = bad, .rate = 1.0}))) << bad;
    for (const double bad : {std::nan(""), -1e-9, 100.1})
        EXPECT_FALSE(parsePadPacket(padPacket({.reach = 0.01, .rate = bad}))) << bad;
    const auto good = padPacket({.sequence = 5, .reach = 0.008, .rate = 0.2});
    EXPECT_EQ(good.size(), 32u);
    EXPECT_EQ(std::string(good.begin(), good.begin() + 4), "TSXD");
    for (size_t size = 0; size < good.size(); ++size)
        EXPECT_FALSE(parsePadPacket(std::span(good).first(size)));
    const auto location = locationPacket({.sequence = 7, .answers = 8, .location = {1.0, -0.5}});
    EXPECT_EQ(std::string(location.begin(), location.begin() + 4), "TSXL");
    EXPECT_EQ(parseLocationPacket(location)->location, glm::dvec2(1.0, -0.5));
    EXPECT_FALSE(parsePadPacket(location));
    EXPECT_FALSE(parseForcePacket(location));
}

TEST(ExternalDevice, CountsWhatIsMalformedRepeatedOrFromAnother) {
    ExternalDevice device(0);
    Client first(device.port()), second(device.port());
    first.say(Bytes{'T', 'S', 'X'});
    first.say(Bytes(1000, 7));
    first.say(Bytes{});
    ASSERT_TRUE(eventually([&] { return device.report().malformed == 3; }));
    EXPECT_EQ(device.report().state, LinkState::Searching) << "noise makes no client";
    first.sayPlace(10, {0.01, 0.0, 0.0});
    ASSERT_TRUE(eventually([&] { return device.report().reports == 1; }));
    second.sayPlace(11, {0.5, 0.0, 0.0});
    first.sayPlace(10, {0.02, 0.0, 0.0});
    first.sayPlace(9, {0.03, 0.0, 0.0});
    ASSERT_TRUE(eventually([&] { return device.report().ignored == 1 && device.report().repeated == 2; }));
    EXPECT_EQ(device.sample(0.0).position.x, 0.01);
}

TEST(ExternalDevice, ASilentClientGoesStaleThenMakesRoom) {
    ExternalDevice device(0);
    {
        Client first(device.port());
        first.sayPlace(1000, {0.01, 0.0, 0.0});
        ASSERT_TRUE(eventually([&] { return device.sample(0.0).valid; }));
    }
    ASSERT_TRUE(eventually([&] { return device.sample(0.0).age > device.limits().staleAge; }));
    device.apply(command({1.0, 0.0, 0.0})); // to nobody: the client has gone
    ASSERT_TRUE(eventually([&] { return !device.sample(0.0).valid; }));
    Client second(device.port());
    second.sayPlace(1, {0.02, 0.0, 0.0}); // begins its own count
    ASSERT_TRUE(eventually([&] { return device.sample(0.0).valid; }));
    EXPECT_EQ(device.sample(0.0).position.x, 0.02);
    EXPECT_EQ(device.report().connects, 2u);
}

TEST(ExternalDevice, TheLastWordIsZero) {
    auto device = std::make_unique<ExternalDevice>(0);
    Client client(device->port());
    client.sayPlace(1, {});
    ASSERT_TRUE(eventually([&] { return device->sample(0.0).valid; }));
    device->apply(command({1.0, 0.0, 0.0}));
    ASSERT_TRUE(eventually([&] { return device->report().sent >= 1; }));
    device.reset();
    const auto force = client.force();
    ASSERT_TRUE(force);
    EXPECT_EQ(force->force, glm::dvec3(0.0));
    EXPECT_GE(force->sequence, 2u);
}

TEST(ExternalDevice, AServoThatFallsSilentIsZeroForceToTheClient) {
    ExternalDevice device(0);
    Client client(device.port());
    client.sayPlace(1, {0, 0, 0});
    ASSERT_TRUE(eventually([&] { return device.sample(0.0).valid; }));
    ASSERT_TRUE(eventually([&] {
        device.apply(command({0.0, 2.0, 0.0}));
        const auto heard = client.force();
        return heard && heard->force.y > 1.0;
    }));
    EXPECT_TRUE(eventually([&] { // no further order
        const auto heard = client.force();
        return heard && heard->force == glm::dvec3(0.0);
    }));
    const uint64_t sent = device.report().sent;
    EXPECT_TRUE(eventually([&] { return device.report().sent > sent; })) << "it must be kept hearing";
}

TEST(ExternalDevice, AClientThatIsTakenForGoneHearsZeroLast) {
    ExternalDevice device(0);
    Client client(device.port());
    client.sayPlace(1, {0, 0, 0});
    ASSERT_TRUE(eventually([&] { return device.sample(0.0).valid; }));
    std::optional<ForcePacket> last;
    const auto hear = [&] {
        if (const auto heard = client.force())
            last = heard;
    };
    ASSERT_TRUE(eventually([&] {
        device.apply(command({0.0, 2.0, 0.0}));
        hear();
        return !device.sample(0.0).valid;
    }));
    hear();
    ASSERT_TRUE(last);
    EXPECT_EQ(last->force, glm::dvec3(0.0));
}

TEST(ExternalDevice, ListensOnTheLoopbackAlone) {
    const ExternalDevice device(0);
    char local[32];
    std::snprintf(local, sizeof local, "0100007F:%04X", device.port()); // 127.0.0.1 as the kernel prints it
    std::ifstream table("/proc/net/udp");
    const std::string sockets{std::istreambuf_iterator<char>(table), {}};
    EXPECT_NE(sockets.find(local), std::string::npos) << sockets;
}

TEST(ExternalDevice, APortThatIsTakenIsAnError) {
    const ExternalDevice device(0);
    try {
        const ExternalDevice again(device.port());
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(std::to_string(device.port())), std::string::npos);
        EXPECT_FALSE(error.remedy().empty());
    }
}

TEST(ExternalDevice, AFloodOfNoiseDoesNotKeepForcesFromTheClient) {
    ExternalDevice device(0);
    Client client(device.port());
    client.sayPlace(1, {});
    ASSERT_TRUE(eventually([&] { return device.sample(0.0).valid; }));
    std::atomic<bool> stop{false};
    std::thread noise([&] {
        Client other(device.port());
        const Bytes bytes(72, 0x5A);
        while (!stop)
            other.say(bytes);
    });
    EXPECT_TRUE(eventually([&] { return device.report().malformed > 100; }));
    bool heard = false;
    for (uint32_t i = 2; i < 200 && !heard; ++i) {
        client.sayPlace(i, {});
        device.apply(command({1.0, 0.0, 0.0}));
        const auto force = client.force();
        heard = force && force->force.x == 1.0;
    }
    stop = true;
    noise.join();
    EXPECT_TRUE(heard);
}

} // namespace
} // namespace touchstone

#include "devices/external/external_device.h"

#include "devices/link/little_endian.h"
#include "engine/core/error.h"
#include "engine/core/float_mode.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace touchstone {

namespace {

constexpr int kPollMs = 1;                  // maximum delay of an order while a client is connected
constexpr int kLonelyPollMs = 20;           // the same without a client
constexpr int kMaxInOneTurn = 64;           // maximum packets per turn before the order is sent
constexpr int64_t kKeepAliveNs = 5'000'000; // maximum interval between packets to a client

sockaddr_in loopback(uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(port);
    return address;
}

std::string waitingFor(uint16_t port) {
    return "waiting for a program to send places to 127.0.0.1:" + std::to_string(port);
}

} // namespace

ExternalDevice::ExternalDevice(uint16_t port) {
    socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    sockaddr_in address = loopback(port);
    socklen_t length = sizeof address;
    if (socket_ < 0 || ::bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
        ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &length) != 0) {
        const std::string problem = std::strerror(errno);
        if (socket_ >= 0)
            ::close(socket_);
        throw Error("external device", "127.0.0.1:" + std::to_string(port), problem,
                    "another program listens there: end it, or choose another port (--device udp:PORT)");
    }
    port_ = ntohs(address.sin_port);
    emptyNs_ = steadyNs();
    monitor_.disconnected(LinkState::Searching, waitingFor(port_));
    thread_ = std::thread([this] { run(); });
}

ExternalDevice::~ExternalDevice() {
    stop_.store(true, std::memory_order_relaxed);
    thread_.join();
    ::close(socket_);
}

void ExternalDevice::run() {
    enterFloatMode();
    monitor_.realtime.store(enterIoPriority(), std::memory_order_relaxed);
    while (!stop_.load(std::memory_order_relaxed)) {
        const bool alone = client_ == Client{};
        receive();
        const int64_t now = steadyNs();
        if (!alone && static_cast<double>(now - heardNs_) > 1e9 * kClientSilence)
            leave();
        const bool news = mailbox_.updateOrder();
        if (client_ != Client{} && (news || now - sentNs_ >= kKeepAliveNs))
            send(mailbox_.order(now), now);
    }
    if (client_ != Client{})
        send(ForceOrder{}, steadyNs());
}

/// Waits for a packet and takes all that are queued. A queued packet may have arrived at any time since the
/// socket was last empty, and is dated to that time.
void ExternalDevice::receive() {
    int64_t arrivedNs = emptyNs_;
    for (int n = 0; n < kMaxInOneTurn; ++n) {
        std::array<uint8_t, 256> packet; // longer packets are truncated and remain malformed
        sockaddr_in from{};
        socklen_t length = sizeof from;
        const ssize_t size =
            ::recvfrom(socket_, packet.data(), packet.size(), 0, reinterpret_cast<sockaddr*>(&from), &length);
        if (size >= 0) {
            take(std::span(packet).first(static_cast<size_t>(size)), {from.sin_addr.s_addr, from.sin_port},
                 arrivedNs);
            continue;
        }
        if (errno == ECONNREFUSED) // a client that has exited receives no force
            continue;
        emptyNs_ = steadyNs();
        if (n > 0)
            return;
        pollfd waiting{socket_, POLLIN, 0};
        if (::poll(&waiting, 1, client_ == Client{} ? kLonelyPollMs : kPollMs) <= 0)
            return;
        arrivedNs = steadyNs();
    }
}

void ExternalDevice::take(std::span<const uint8_t> bytes, const Client& from, int64_t arrivedNs) {
    if (const auto pad = parsePadPacket(bytes))
        return declare(*pad, from);
    const auto packet = parsePlacePacket(bytes);
    const bool local = ntohl(from.address) >> 24 == 127;
    if (!packet)
        return LinkMonitor::count(monitor_.malformed);
    if (!local || (client_ != Client{} && !(client_ == from)))
        return LinkMonitor::count(monitor_.ignored);
    if (client_ == Client{}) {
        welcome(from);
    } else {
        const SequenceStep step = sequenceStep(heard_, packet->sequence);
        if (!step.fresh)
            return LinkMonitor::count(monitor_.repeated);
        LinkMonitor::count(monitor_.lost, step.lost);
    }
    heard_ = packet->sequence;
    heardNs_ = arrivedNs;
    DeviceReading reading;
    reading.position = packet->position;
    reading.orientation = packet->orientation;
    reading.buttons = packet->buttons;
    reading.takenNs = arrivedNs;
    reading.valid = true;
    mailbox_.publish(reading);
    LinkMonitor::count(monitor_.reports);
}

/// Of the client that is connected alone; anybody else's is ignored.
void ExternalDevice::declare(const PadPacket& packet, const Client& from) {
    if (client_ == Client{} || !(client_ == from))
        return LinkMonitor::count(monitor_.ignored);
    padRate_.store(packet.rate, std::memory_order_relaxed);
    padReach_.store(packet.reach, std::memory_order_relaxed);
}

void ExternalDevice::welcome(const Client& client) {
    client_ = client;
    padReach_.store(0.0, std::memory_order_relaxed);
    monitor_.connected("127.0.0.1:" + std::to_string(ntohs(client.port)));
}

void ExternalDevice::leave() {
    send(ForceOrder{}, steadyNs());
    client_ = {};
    padReach_.store(0.0, std::memory_order_relaxed);
    mailbox_.publish(DeviceReading{});
    monitor_.disconnected(LinkState::Searching, waitingFor(port_));
}

void ExternalDevice::send(const ForceOrder& order, int64_t nowNs) {
    sentNs_ = nowNs;
    const auto bytes = forcePacket({++said_, heard_, order.force, order.torque});
    sockaddr_in to = loopback(ntohs(client_.port));
    to.sin_addr.s_addr = client_.address;
    const ssize_t sent =
        ::sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&to), sizeof to);
    LinkMonitor::count(sent == static_cast<ssize_t>(bytes.size()) ? monitor_.sent : monitor_.sendFailures);
    if (padReach_.load(std::memory_order_relaxed) <= 0.0)
        return;
    const auto location = locationPacket({said_, heard_, order.location});
    if (::sendto(socket_, location.data(), location.size(), 0, reinterpret_cast<sockaddr*>(&to), sizeof to) !=
        static_cast<ssize_t>(location.size()))
        LinkMonitor::count(monitor_.sendFailures);
}

} // namespace touchstone

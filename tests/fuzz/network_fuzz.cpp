// Random bytes at the door of `touchstone serve`: requests, handshakes and frames that are right, wrong, cut
// off or in pieces, over TCP and the Unix socket. None may crash it or stop it from answering the next
// client. network_fuzz [SECONDS [SEED]]; CTest runs ten seconds, the long form is an hour (3600).

#include "server/network.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <string_view>
#include <thread>

namespace {

using namespace touchstone::server;

[[noreturn]] void fail(const std::string& what) {
    std::fprintf(stderr, "network_fuzz: %s\n", what.c_str());
    std::_Exit(1);
}

/// Nobody's port at this moment.
int freePort() {
    const int probe = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (bind(probe, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
        getsockname(probe, reinterpret_cast<sockaddr*>(&address), &size) != 0)
        fail("no port is free");
    close(probe);
    return ntohs(address.sin_port);
}

/// A connection of a client's; what cannot be sent or read in time is left.
class Connection {
  public:
    Connection(int port, const std::string& path)
        : socket_(socket(port != 0 ? AF_INET : AF_UNIX, SOCK_STREAM, 0)) {
        const timeval patience{0, 20'000};
        (void)setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
        (void)setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
        if (port != 0) {
            sockaddr_in address{};
            address.sin_family = AF_INET;
            address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
            address.sin_port = htons(static_cast<uint16_t>(port));
            open_ = connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
        } else {
            sockaddr_un address{};
            address.sun_family = AF_UNIX;
            std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
            open_ = connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
        }
    }
    ~Connection() { close(socket_); }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    void send(std::string_view bytes) {
        while (open_ && !bytes.empty()) {
            const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
            if (sent <= 0)
                return;
            bytes.remove_prefix(static_cast<size_t>(sent));
        }
    }
    /// What is there, at most 64 KiB; empty: nothing came in time, or the end.
    std::string receive() {
        std::string bytes(1 << 16, '\0');
        const ssize_t got = recv(socket_, bytes.data(), bytes.size(), 0);
        bytes.resize(got > 0 ? static_cast<size_t>(got) : 0);
        return bytes;
    }
    [[nodiscard]] bool open() const { return open_; }

  private:
    int socket_;
    bool open_ = false;
};

class Fuzz {
  public:
    Fuzz(int port, std::string path, std::string token, uint64_t seed)
        : port_(port), path_(std::move(path)), token_(std::move(token)), random_(seed) {}

    /// One client, from its first byte to its last.
    void client() {
        const bool tcp = below(2) == 0;
        Connection connection(tcp ? port_ : 0, path_);
        ++connections;
        if (below(4) == 0) {
            pieces(connection, request());
            replies += connection.receive().empty() ? 0 : 1;
            return;
        }
        pieces(connection, handshake(tcp));
        const std::string answer = connection.receive();
        const bool opened = answer.find(" 101 ") != std::string::npos;
        handshakes += opened ? 1 : 0;
        if (!opened && below(4) != 0)
            return;
        for (size_t i = 0, count = below(12); i < count; ++i) {
            pieces(connection, frame());
            if (below(4) == 0)
                replies += connection.receive().empty() ? 0 : 1;
        }
    }
    /// A client that does all right is answered.
    [[nodiscard]] bool answers() {
        for (int attempt = 0; attempt < 600; ++attempt) { // until the connections that were left are closed
            Connection connection(0, path_);
            connection.send(
                "GET / HTTP/1.1\r\nHost: unix\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n\r\n");
            std::string got;
            for (int i = 0; i < 50 && connection.open() && got.find("\r\n\r\n") == std::string::npos; ++i)
                got += connection.receive();
            if (got.find(" 101 ") == std::string::npos) {
                std::this_thread::sleep_for(std::chrono::milliseconds(50));
                continue;
            }
            connection.send(framed(R"({"id":77,"do":"ping"})", 0x81, true));
            for (int i = 0; i < 500; ++i)
                if ((got += connection.receive()).find(R"("id":77)") != std::string::npos)
                    return true;
        }
        return false;
    }

    uint64_t connections = 0, handshakes = 0, replies = 0;

  private:
    size_t below(size_t count) { return count > 0 ? random_() % count : 0; }
    template <class T, size_t N>
    const T& oneOf(const T (&all)[N]) {
        return all[below(N)];
    }
    std::string noise(size_t most) {
        std::string bytes(below(most + 1), '\0');
        for (char& byte : bytes)
            byte = static_cast<char>(random_());
        return bytes;
    }
    /// In one piece, in several, damaged, or cut off.
    void pieces(Connection& connection, std::string bytes) {
        if (below(8) == 0 && !bytes.empty())
            bytes[below(bytes.size())] = static_cast<char>(random_());
        if (below(16) == 0)
            bytes.resize(below(bytes.size() + 1));
        for (std::string_view rest = bytes; !rest.empty();) {
            const size_t size = below(4) == 0 ? 1 + below(rest.size()) : rest.size();
            connection.send(rest.substr(0, size));
            rest.remove_prefix(size);
        }
    }
    std::string headers(bool tcp) {
        static const char* const kOrigins[]{"null", "http://evil.example", "http://localhost:8000", "",
                                            "\xff"};
        std::string text =
            "Host: " + (tcp ? "127.0.0.1:" + std::to_string(port_) : std::string("unix")) + "\r\n";
        if (below(6) == 0)
            text += std::string("Origin: ") + oneOf(kOrigins) + "\r\n";
        if (below(10) == 0)
            text += "X: " + std::string(below(below(4) == 0 ? 100'000 : 3000), 'x') + "\r\n";
        if (below(10) == 0)
            text += noise(200) + "\r\n";
        return text;
    }
    std::string request() {
        static const char* const kMethods[]{"GET", "GET", "GET", "POST", "OPTIONS", "CONNECT", "PRI", ""};
        static const char* const kPaths[]{"/",
                                          "/viewer.js",
                                          "/style.css",
                                          "/scene",
                                          "/../main.cpp",
                                          "/%2e%2e/main.cpp",
                                          "//etc/passwd",
                                          "/scene?token=",
                                          "*",
                                          "/%00",
                                          "/?",
                                          ""};
        std::string path = oneOf(kPaths);
        if (below(4) == 0)
            path = "/scene?token=" + (below(2) == 0 ? token_ : noise(300));
        if (below(8) == 0)
            path += noise(60);
        const std::string body = below(8) == 0 ? "Content-Length: " + std::to_string(random_()) + "\r\n" : "";
        return std::string(oneOf(kMethods)) + " " + path + " HTTP/1." + (below(8) == 0 ? "0" : "1") + "\r\n" +
               headers(below(8) != 0) + body + "\r\n" + (below(8) == 0 ? noise(500) : "");
    }
    std::string handshake(bool tcp) {
        static const char* const kProtocols[]{"timer", "touchstone", "raw", ",,,"};
        std::string text = "GET / HTTP/1.1\r\n" + headers(tcp) +
                           "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: " +
                           (below(16) == 0 ? std::to_string(below(300)) : "13") + "\r\nSec-WebSocket-Key: " +
                           (below(16) == 0 ? noise(100) : "AAAAAAAAAAAAAAAAAAAAAA==") + "\r\n";
        if (below(12) == 0)
            text += std::string("Sec-WebSocket-Protocol: ") + oneOf(kProtocols) + "\r\n";
        if (below(12) == 0)
            text += "Sec-WebSocket-Extensions: permessage-deflate; client_max_window_bits=" +
                    std::to_string(below(20)) + "\r\n";
        return text + "\r\n";
    }
    /// RFC 6455; `stated`: the length that its head tells.
    std::string framed(std::string_view payload, unsigned first, bool masked,
                       uint64_t stated = ~uint64_t{0}) {
        const uint64_t size = stated == ~uint64_t{0} ? payload.size() : stated;
        const unsigned mask = masked ? 0x80 : 0;
        std::string bytes{static_cast<char>(first)};
        const auto add = [&](int count) {
            for (int i = count - 1; i >= 0; --i)
                bytes += static_cast<char>(size >> (8 * i));
        };
        if (size < 126) {
            bytes += static_cast<char>(mask | size);
        } else if (size < 65'536) {
            bytes += static_cast<char>(mask | 126);
            add(2);
        } else {
            bytes += static_cast<char>(mask | 127);
            add(8);
        }
        std::array<char, 4> key{};
        if (masked) {
            for (char& byte : key)
                byte = static_cast<char>(random_());
            bytes.append(key.data(), key.size());
        }
        for (size_t i = 0; i < payload.size(); ++i)
            bytes += static_cast<char>(payload[i] ^ key[i % 4]);
        return bytes;
    }
    std::string message() {
        static const char* const kMessages[]{
            R"({"id":1,"do":"ping"})",
            R"({"id":2,"do":"settings"})",
            R"({"id":3,"do":"subscribe","ticks":true,"states":1000})",
            R"({"id":4,"do":"drive"})",
            R"({"id":5,"do":"load","scene":"plane.glb"})",
            R"({"id":6,"do":"touch","positions":[[0,0.01,0],[0,-0.01,0]]})",
            R"({"id":7,"do":"move","object":0,"position":[0,0.001,0]})",
            R"({"id":8,"do":"materials"})",
            R"({"do":)",
            "[]",
            "",
        };
        if (below(6) == 0)
            return R"({"do":"authenticate","token":")" + (below(4) == 0 ? noise(70) : token_) + "\"}";
        if (below(8) == 0)
            return std::string(below(40'000), '[');
        return oneOf(kMessages);
    }
    std::string frame() {
        static constexpr unsigned kFirst[]{0x01, 0x00, 0x80, 0x82, 0x88, 0x89, 0x8a, 0x83, 0xc1, 0x7f, 0xff};
        static constexpr uint64_t kStated[]{0,
                                            125,
                                            126,
                                            65'535,
                                            65'536,
                                            uint64_t{1} << 25,
                                            uint64_t{1} << 40,
                                            ~uint64_t{0} >> 1,
                                            (~uint64_t{0}) - 1};
        const unsigned first = below(3) == 0 ? oneOf(kFirst) : 0x81;
        const std::string payload = below(8) == 0 ? noise(200) : message();
        return framed(payload, first, below(12) != 0, below(16) == 0 ? oneOf(kStated) : ~uint64_t{0});
    }

    int port_;
    std::string path_, token_;
    std::mt19937_64 random_;
};

std::string tokenIn(const std::filesystem::path& file) {
    for (int i = 0; i < 600; ++i) {
        std::string token;
        if (std::ifstream(file) >> token && token.size() == 64)
            return token;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    fail("the server does not come up");
}

int fuzz(const ServeOptions& options, const std::filesystem::path& folder, double seconds, uint64_t seed) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    Fuzz fuzz(options.port, options.socket,
              tokenIn(folder / "touchstone" / ("serve-" + std::to_string(options.port) + ".token")), seed);
    uint64_t asked = 0;
    for (int i = 0; std::chrono::steady_clock::now() < end; ++i) {
        fuzz.client();
        if (i % 200 == 0 && ++asked > 0 && !fuzz.answers())
            fail("a client that does all right is not answered");
    }
    if (!fuzz.answers())
        fail("a client that does all right is not answered at the end");
    std::printf(
        "%llu connections, %llu handshakes, %llu replies; %llu times a client was answered beside them\n",
        static_cast<unsigned long long>(fuzz.connections), static_cast<unsigned long long>(fuzz.handshakes),
        static_cast<unsigned long long>(fuzz.replies), static_cast<unsigned long long>(asked + 1));
    return fuzz.handshakes > 0 && fuzz.handshakes < fuzz.connections && fuzz.replies > 0 ? 0 : 1;
}

} // namespace

int main(int count, char** arguments) {
    const double seconds = count > 1 ? std::atof(arguments[1]) : 10.0;
    const uint64_t seed = count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 1;
    (void)std::signal(SIGPIPE, SIG_IGN);
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("network_fuzz." + std::to_string(getpid()));
    std::filesystem::create_directory(folder);
    (void)setenv("XDG_RUNTIME_DIR", folder.c_str(), 1);
    for (const char* scene : {"box.glb", "plane.glb"})
        std::filesystem::copy_file(std::filesystem::path(TOUCHSTONE_ASSETS) / scene, folder / scene);
    ServeOptions options;
    options.port = freePort();
    options.socket = (folder / "touch.sock").string();
    options.root = folder.string();
    options.scene = (folder / "box.glb").string();
    std::thread server([&] {
        try {
            serve(options, TOUCHSTONE_WEB);
        } catch (const std::exception& error) {
            fail(error.what());
        }
    });
    const int status = fuzz(options, folder, seconds, seed);
    stopServing();
    server.join();
    std::filesystem::remove_all(folder);
    return status;
}

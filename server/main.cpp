// touchstone serve: the network around TouchServer. One thread for all connections; the servo has its own.

#include "server/access.h"
#include "server/touch_server.h"

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <libwebsockets.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <map>
#include <string>

namespace touchstone::server {
namespace {

using Clock = std::chrono::steady_clock;

constexpr size_t kMostClients = 16, kMostMessage = size_t{24} << 20, kMostFragments = 64;
constexpr size_t kMostQueued = 64, kMostQueuedReplies = 1000; // of states and ticks; of everything
constexpr double kMessagesASecond = 2000.0;
constexpr auto kUnknownFor = std::chrono::seconds(5);
constexpr const char* kSocketHost = "unix";

volatile std::sig_atomic_t stopping = 0;

struct Peer {
    uint64_t number = 0;
    bool trusted = false, closing = false;
    std::string incoming;
    std::deque<Outgoing> queue;
    double allowance = kMessagesASecond;
    Clock::time_point last = Clock::now(), since = Clock::now();
};

struct Network {
    TouchServer* server = nullptr;
    lws_context* context = nullptr;
    lws_sorted_usec_list_t timer{};
    std::map<lws*, Peer> peers;
    uint64_t numbers = 0;
    int port = 0;
    std::string web; ///< folder of the page
};
Network network; // lws gives its callbacks no other place for it that all of them reach

std::string header(lws* wsi, lws_token_indexes which) {
    char text[256] = "";
    return lws_hdr_copy(wsi, text, sizeof text, which) > 0 ? text : "";
}

bool fromSocket(lws* wsi) {
    return std::string_view(lws_get_vhost_name(lws_get_vhost(wsi))) == kSocketHost;
}

/// From this machine, and by no other page than ours.
bool mayConnect(lws* wsi) {
    if (lws_hdr_total_length(wsi, WSI_TOKEN_ORIGIN) > 255 || lws_hdr_total_length(wsi, WSI_TOKEN_HOST) > 255)
        return false;
    const std::string origin = header(wsi, WSI_TOKEN_ORIGIN);
    if (fromSocket(wsi))
        return origin.empty();
    return isOwnHost(header(wsi, WSI_TOKEN_HOST), network.port) && isOwnOrigin(origin, network.port);
}

/// Gives every client what is meant for it. Who reads too slowly loses states and ticks, and at last the
/// connection.
void deliver() {
    for (Outgoing& message : network.server->takeOutgoing())
        for (auto& [wsi, peer] : network.peers) {
            if (message.client != 0 ? message.client != peer.number : !peer.trusted)
                continue;
            const bool stream = message.binary || message.bytes.starts_with(R"({"command")");
            if (stream && peer.queue.size() >= kMostQueued)
                continue;
            if (peer.queue.size() >= kMostQueuedReplies)
                peer.closing = true;
            else
                peer.queue.push_back(message);
            lws_callback_on_writable(wsi);
        }
}

/// The key of the person at the device.
void readKeys() {
    char key = 0;
    while (read(STDIN_FILENO, &key, 1) == 1)
        if (key == ' ')
            network.server->takeBack();
}

void onTimer(lws_sorted_usec_list_t*) {
    lws_sul_schedule(network.context, 0, &network.timer, onTimer,
                     static_cast<lws_usec_t>(1e6 * network.server->pumpPeriod()));
    readKeys();
    network.server->pump();
    deliver();
    for (auto& [wsi, peer] : network.peers)
        if (!peer.trusted && Clock::now() - peer.since > kUnknownFor) {
            peer.closing = true;
            lws_callback_on_writable(wsi);
        }
}

/// A page or the scene. 0 goes on, other than 0 closes.
int serveFile(lws* wsi, const std::string& path) {
    static constexpr char kHeaders[] = "content-security-policy: default-src 'none'; script-src 'self'; "
                                       "style-src 'self'; connect-src 'self' ws: ; "
                                       "img-src 'self'; frame-ancestors 'none'\r\nx-content-type-options: "
                                       "nosniff\r\ncache-control: no-store\r\n"
                                       "referrer-policy: no-referrer\r\n";
    std::string file;
    const char* type = "text/html";
    int memory = -1;
    if (path == "/" || path == "/index.html")
        file = network.web + "/index.html";
    else if (path == "/viewer.js" || path == "/style.css") {
        file = network.web + path;
        type = path == "/viewer.js" ? "text/javascript" : "text/css";
    } else if (path == "/scene") {
        char token[128] = "";
        const char* given = lws_get_urlarg_by_name(wsi, "token=", token, sizeof token);
        if (given == nullptr || !network.server->mayRead(given) || network.server->triangles().empty())
            return lws_return_http_status(wsi, HTTP_STATUS_FORBIDDEN, nullptr) < 0
                       ? -1
                       : lws_http_transaction_completed(wsi);
        // A file in memory: lws sends files piece by piece.
        const std::vector<float>& corners = network.server->triangles();
        memory = memfd_create("scene", MFD_CLOEXEC);
        const auto size = static_cast<ssize_t>(corners.size() * sizeof(float));
        if (memory < 0 || write(memory, corners.data(), static_cast<size_t>(size)) != size)
            file.clear();
        else
            file = "/proc/self/fd/" + std::to_string(memory);
        type = "application/octet-stream";
    }
    if (file.empty() || lws_hdr_total_length(wsi, WSI_TOKEN_GET_URI) <= 0)
        return lws_return_http_status(wsi, HTTP_STATUS_NOT_FOUND, nullptr) < 0
                   ? -1
                   : lws_http_transaction_completed(wsi);
    const int sent =
        lws_serve_http_file(wsi, file.c_str(), type, kHeaders, static_cast<int>(sizeof kHeaders - 1));
    if (memory >= 0)
        (void)close(memory); // lws has opened it by then
    return sent < 0 ? -1 : sent > 0 ? lws_http_transaction_completed(wsi) : 0;
}

/// False: close the connection.
bool received(lws* wsi, Peer& peer, const char* bytes, size_t count) {
    const Clock::time_point now = Clock::now();
    peer.allowance =
        std::min(kMessagesASecond,
                 peer.allowance + kMessagesASecond * std::chrono::duration<double>(now - peer.last).count());
    peer.last = now;
    peer.incoming.append(bytes, count);
    if (peer.incoming.size() > kMostMessage)
        return false;
    if (!lws_is_final_fragment(wsi) || lws_remaining_packet_payload(wsi) > 0)
        return true;
    const std::string message = std::exchange(peer.incoming, {});
    if ((peer.allowance -= 1.0) < 0.0 || lws_frame_is_binary(wsi))
        return false;
    if (!network.server->receive(peer.number, message))
        return false;
    peer.trusted = true;
    deliver();
    return true;
}

bool writeNext(lws* wsi, Peer& peer) {
    if (peer.queue.empty())
        return true;
    const Outgoing message = std::move(peer.queue.front());
    peer.queue.pop_front();
    std::string frame(LWS_PRE, '\0');
    frame += message.bytes;
    const int written = lws_write(wsi, reinterpret_cast<unsigned char*>(frame.data()) + LWS_PRE,
                                  message.bytes.size(), message.binary ? LWS_WRITE_BINARY : LWS_WRITE_TEXT);
    if (!peer.queue.empty())
        lws_callback_on_writable(wsi);
    return written >= static_cast<int>(message.bytes.size());
}

int onEvent(lws* wsi, lws_callback_reasons reason, void* user, void* in, size_t length) {
    const auto peer = network.peers.find(wsi);
    switch (reason) {
    case LWS_CALLBACK_HTTP:
        if (!mayConnect(wsi))
            return lws_return_http_status(wsi, HTTP_STATUS_FORBIDDEN, nullptr) < 0
                       ? -1
                       : lws_http_transaction_completed(wsi);
        return serveFile(wsi, std::string(static_cast<const char*>(in), length));
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
        return mayConnect(wsi) && network.peers.size() < kMostClients ? 0 : 1;
    case LWS_CALLBACK_ESTABLISHED: {
        Peer& joined = network.peers[wsi];
        joined.number = ++network.numbers;
        joined.trusted = fromSocket(wsi);
        network.server->join(joined.number, joined.trusted);
        return 0;
    }
    case LWS_CALLBACK_RECEIVE:
        return peer != network.peers.end() &&
                       received(wsi, peer->second, static_cast<const char*>(in), length)
                   ? 0
                   : -1;
    case LWS_CALLBACK_SERVER_WRITEABLE:
        return peer != network.peers.end() && !peer->second.closing && writeNext(wsi, peer->second) ? 0 : -1;
    case LWS_CALLBACK_CLOSED:
        if (peer != network.peers.end()) {
            network.server->leave(peer->second.number);
            network.peers.erase(peer);
            deliver();
        }
        return 0;
    default:
        return lws_callback_http_dummy(wsi, reason, user, in, length);
    }
}

const lws_protocols kProtocols[]{{"touchstone", onEvent, 0, 64 * 1024, 0, nullptr, 0},
                                 {nullptr, nullptr, 0, 0, 0, nullptr, 0}};

/// Keys without Enter, for as long as this lives.
class RawTerminal {
  public:
    RawTerminal() : flags_(fcntl(STDIN_FILENO, F_GETFL)) {
        (void)fcntl(STDIN_FILENO, F_SETFL, flags_ | O_NONBLOCK);
        if (isatty(STDIN_FILENO) == 0 || tcgetattr(STDIN_FILENO, &before_) != 0)
            return;
        termios raw = before_;
        raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
        raw_ = tcsetattr(STDIN_FILENO, TCSANOW, &raw) == 0;
    }
    ~RawTerminal() {
        (void)fcntl(STDIN_FILENO, F_SETFL, flags_);
        if (raw_)
            (void)tcsetattr(STDIN_FILENO, TCSANOW, &before_);
    }
    RawTerminal(const RawTerminal&) = delete;
    RawTerminal& operator=(const RawTerminal&) = delete;

  private:
    int flags_;
    termios before_{};
    bool raw_ = false;
};

void listen(const ServeOptions& options) {
    lws_context_creation_info info{};
    info.protocols = kProtocols;
    info.options = LWS_SERVER_OPTION_EXPLICIT_VHOSTS;
    info.gid = info.uid = static_cast<uint32_t>(-1);
    lws_set_log_level(LLL_ERR, nullptr);
    network.context = lws_create_context(&info);
    if (network.context == nullptr)
        throw std::runtime_error("libwebsockets cannot be started");
    if (options.port != 0) {
        lws_context_creation_info tcp = info;
        tcp.vhost_name = "loopback";
        tcp.iface = "127.0.0.1";
        tcp.port = options.port;
        if (lws_create_vhost(network.context, &tcp) == nullptr)
            throw std::runtime_error("port " + std::to_string(options.port) +
                                     ": cannot be listened to\n  remedy: --port N");
    }
    if (!options.socket.empty()) {
        lws_context_creation_info local = info;
        local.vhost_name = kSocketHost;
        local.iface = options.socket.c_str();
        local.options |= LWS_SERVER_OPTION_UNIX_SOCK;
        const mode_t before = umask(0177); // never, not for a moment, open to others
        lws_vhost* made = lws_create_vhost(network.context, &local);
        (void)umask(before);
        if (made == nullptr || chmod(options.socket.c_str(), 0600) != 0)
            throw std::runtime_error(options.socket + ": cannot be listened to");
    }
}

int serve(ServeOptions options, const std::string& web) {
    network.web = web;
    network.port = options.port;
    const std::string token = newToken();
    const std::string tokenFile = options.port != 0 ? writeToken(token, options.port) : std::string();
    TouchServer server(options, token);
    network.server = &server;
    listen(options);
    if (options.port != 0)
        std::printf("http://127.0.0.1:%d/#%s\ntoken in %s\n", options.port, token.c_str(), tokenFile.c_str());
    if (!options.socket.empty())
        std::printf("socket %s\n", options.socket.c_str());
    std::printf("Space takes the drive and the force back, and gives the force again; Ctrl+C ends\n");
    std::fflush(stdout);
    const RawTerminal terminal;
    onTimer(nullptr);
    while (stopping == 0 && lws_service(network.context, 0) >= 0) {
    }
    lws_context_destroy(network.context);
    if (!tokenFile.empty())
        (void)unlink(tokenFile.c_str());
    if (!options.socket.empty())
        (void)unlink(options.socket.c_str());
    return 0;
}

/// CLI::Range lets NaN pass: it asks whether a value is below or above.
std::string isNumber(const std::string& text) {
    return std::isnan(std::strtod(text.c_str(), nullptr)) ? text + " is no number" : std::string();
}

} // namespace
} // namespace touchstone::server

int main(int count, char** arguments) {
    using namespace touchstone::server;
    ServeOptions options;
    options.port = 8790;
    CLI::App app{"Touch for other programs: they load scenes, change settings and get states and ticks over "
                 "a WebSocket "
                 "(docs/server.md)."};
    app.name("touchstone serve");
    app.add_option("SCENE", options.scene, "Model to begin with")->type_name("");
    app.add_option("--root", options.root, "Clients may name scenes below this folder [.]")
        ->type_name("DIR")
        ->check(CLI::ExistingDirectory);
    app.add_option("--port", options.port, "On 127.0.0.1, with a token; 0: none [8790]")
        ->type_name("N")
        ->check(CLI::Range(0, 65535));
    app.add_option("--socket", options.socket, "Also listen to this Unix socket, of mode 0600")
        ->type_name("PATH");
    app.add_option("--device", options.device,
                   "What is held: stroke[:NAME] (a simulated hand), or as `run --device` [stroke]")
        ->type_name("DEVICE");
    app.add_option("--rate", options.rate, "Servo rate [1000]")
        ->type_name("HZ")
        ->check(CLI::Range(100.0, 4000.0))
        ->check(isNumber);
    app.add_option(
           "--control", options.control,
           "Control loop apart from contact, at HZ (docs/control.md): contact may be slower (--rate), or a "
           "client's [none]")
        ->type_name("HZ")
        ->check(CLI::Range(100.0, 4000.0))
        ->check(isNumber);
    app.add_option(
           "--goal-power", options.goalPower,
           "Power that a client's contact may give the hand; 0: late or wrong contact gives no energy [0]")
        ->type_name("W")
        ->check(CLI::Range(0.0, 10.0))
        ->check(isNumber);
    app.add_flag("--allow-write", options.allowWrite, "Clients may record into new files below the root");
    std::string web = TOUCHSTONE_WEB;
    try {
        app.parse(count, arguments);
    } catch (const CLI::Success& answered) { // --help
        return app.exit(answered);
    } catch (const CLI::ParseError& error) {
        std::fprintf(stderr, "touchstone: %s\n  remedy: touchstone serve --help\n", error.what());
        return 2;
    }
    try {
        if (options.port == 0 && options.socket.empty())
            throw std::runtime_error("--port 0 needs --socket");
        struct sigaction action {};
        action.sa_handler = [](int) {
            stopping = 1;
            lws_cancel_service(network.context);
        };
        (void)sigaction(SIGINT, &action, nullptr);
        (void)sigaction(SIGTERM, &action, nullptr);
        (void)signal(SIGPIPE, SIG_IGN);
        const std::filesystem::path installed =
            std::filesystem::read_symlink("/proc/self/exe").parent_path() / "../../share/touchstone/web";
        if (std::filesystem::exists(installed))
            web = installed.lexically_normal().string();
        return serve(options, web);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "touchstone: %s\n", error.what());
        return 1;
    }
}

#include "server/network.h"

#include "server/access.h"
#include "server/pump_timer.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <libwebsockets.h>
#include <netinet/in.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace touchstone::server {
namespace {

using Clock = std::chrono::steady_clock;

constexpr size_t kMostClients = 16, kMostMessage = size_t{24} << 20;
constexpr size_t kMostQueued = 64, kMostQueuedReplies = 1000; // of states and ticks; of everything
constexpr size_t kMostQueuedBytes = size_t{32} << 20; // of everything: the ticks of three paths of 100,000
constexpr double kMessagesASecond = 2000.0;
constexpr auto kUnknownFor = std::chrono::seconds(5);
constexpr const char *kSocketHost = "unix", *kTimer = "timer";

volatile std::sig_atomic_t stopping = 0;

struct Peer {
    uint64_t number = 0;
    bool trusted = false, closing = false;
    std::string incoming;
    std::deque<Outgoing> queue;
    size_t queuedBytes = 0;
    double allowance = kMessagesASecond;
    Clock::time_point last = Clock::now(), since = Clock::now();
};

struct Network {
    TouchServer* server = nullptr;
    lws_context* context = nullptr;
    std::optional<KernelTimer> timer;
    std::map<lws*, Peer> peers;
    uint64_t numbers = 0;
    OwnNames names;
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

/// By a name of this server, and by no other page than ours and those of `--origin`.
bool mayConnect(lws* wsi) {
    if (lws_hdr_total_length(wsi, WSI_TOKEN_ORIGIN) > 255 || lws_hdr_total_length(wsi, WSI_TOKEN_HOST) > 255)
        return false;
    const std::string origin = header(wsi, WSI_TOKEN_ORIGIN);
    if (fromSocket(wsi))
        return origin.empty();
    return isOwnHost(header(wsi, WSI_TOKEN_HOST), network.names) && isOwnOrigin(origin, network.names);
}

/// Gives every client what is meant for it. Who reads too slowly loses states and ticks, and at last the
/// connection.
void deliver() {
    for (Outgoing& message : network.server->takeOutgoing())
        for (auto& [wsi, peer] : network.peers) {
            if (message.client != 0 ? message.client != peer.number : !peer.trusted)
                continue;
            if (message.stream && peer.queue.size() >= kMostQueued)
                continue;
            if (peer.closing)
                continue;
            if (peer.queue.size() >= kMostQueuedReplies || peer.queuedBytes > kMostQueuedBytes) {
                // It never becomes writable where the client does not read.
                peer.closing = true;
                peer.queue.clear();
                lws_set_timeout(wsi, PENDING_TIMEOUT_USER_REASON_BASE, LWS_TO_KILL_ASYNC);
                continue;
            }
            peer.queuedBytes += message.bytes.size();
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

/// The servo has made a tick, or it is time for a look at the rest.
void onTimer() {
    network.timer->clear();
    readKeys();
    network.server->pump();
    deliver();
    for (auto& [wsi, peer] : network.peers)
        if (!peer.trusted && Clock::now() - peer.since > kUnknownFor) {
            peer.closing = true;
            lws_callback_on_writable(wsi);
        }
    network.timer->set(network.server->nextPump());
}

/// A page or the scene. 0 goes on, other than 0 closes.
int serveFile(lws* wsi, const std::string& path) {
    static constexpr char kHeaders[] = "content-security-policy: default-src 'none'; script-src 'self'; "
                                       "style-src 'self'; connect-src 'self' ws: wss: ; "
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
    peer.queuedBytes -= message.bytes.size();
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

int onTimerEvent(lws*, lws_callback_reasons reason, void*, void*, size_t) {
    switch (reason) {
    case LWS_CALLBACK_RAW_RX_FILE:
        onTimer();
        return 0;
    case LWS_CALLBACK_HTTP:
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION: // a client may ask for any protocol by its name
    case LWS_CALLBACK_ESTABLISHED:
        return -1;
    default:
        return 0;
    }
}

const lws_protocols kProtocols[]{{"touchstone", onEvent, 0, 64 * 1024, 0, nullptr, 0},
                                 {kTimer, onTimerEvent, 0, 0, 0, nullptr, 0},
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

/// The process listens by TCP, and every socket of it that does so is at the address. (Debian 12's
/// libwebsockets listens at all addresses where it cannot bind to one, and says nothing.)
bool listensOnlyAt(const std::string& address) {
    bool listens = false;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
        const int descriptor = std::atoi(entry.path().filename().c_str());
        int accepts = 0;
        socklen_t size = sizeof accepts;
        sockaddr_storage bound{};
        socklen_t length = sizeof bound;
        if (getsockopt(descriptor, SOL_SOCKET, SO_ACCEPTCONN, &accepts, &size) != 0 || accepts == 0 ||
            getsockname(descriptor, reinterpret_cast<sockaddr*>(&bound), &length) != 0 ||
            bound.ss_family == AF_UNIX)
            continue;
        in_addr wanted{};
        if (bound.ss_family != AF_INET || inet_pton(AF_INET, address.c_str(), &wanted) != 1 ||
            reinterpret_cast<const sockaddr_in&>(bound).sin_addr.s_addr != wanted.s_addr)
            return false;
        listens = true;
    }
    return listens;
}

/// A server on the address, in the form that libwebsockets wants.
lws_vhost* listenTo(const ServeOptions& options, lws_context_creation_info tcp) {
    tcp.vhost_name = "tcp";
    tcp.iface = isAnyAddress(options.address) ? nullptr : options.address.c_str();
    tcp.port = options.port;
    tcp.alpn = "http/1.1"; // HTTP/2 has no Host header, and browsers would take it over TLS
    // Else it takes no notice of an IPv4 address, and tries again later where it cannot bind.
    tcp.options |= LWS_SERVER_OPTION_DISABLE_IPV6 | LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND;
    if (!options.certificate.empty()) {
        tcp.ssl_cert_filepath = options.certificate.c_str();
        tcp.ssl_private_key_filepath = options.key.c_str();
    }
    lws_vhost* const made = lws_create_vhost(network.context, &tcp);
    if (made == nullptr)
        throw std::runtime_error(options.address + " port " + std::to_string(options.port) +
                                 ": cannot be listened to\n  remedy: --port N" +
                                 (options.certificate.empty()
                                      ? ""
                                      : ", and a certificate and its key as PEM that belong together"));
    if (!listensOnlyAt(options.address))
        throw std::runtime_error("libwebsockets listens elsewhere than at " + options.address);
    return made;
}

lws_vhost* listenTo(const std::string& socket, lws_context_creation_info local) {
    local.vhost_name = kSocketHost;
    local.iface = socket.c_str();
    local.options |= LWS_SERVER_OPTION_UNIX_SOCK;
    const mode_t before = umask(0177); // never, not for a moment, open to others
    lws_vhost* const made = lws_create_vhost(network.context, &local);
    (void)umask(before);
    if (made == nullptr || chmod(socket.c_str(), 0600) != 0)
        throw std::runtime_error(socket + ": cannot be listened to");
    return made;
}

void listen(const ServeOptions& options) {
    lws_context_creation_info info{};
    info.protocols = kProtocols;
    info.options = LWS_SERVER_OPTION_EXPLICIT_VHOSTS;
    if (!options.certificate.empty())
        info.options |= LWS_SERVER_OPTION_DO_SSL_GLOBAL_INIT;
    info.gid = info.uid = static_cast<uint32_t>(-1);
    lws_set_log_level(LLL_ERR, nullptr);
    network.context = lws_create_context(&info);
    if (network.context == nullptr)
        throw std::runtime_error("libwebsockets cannot be started");
    lws_vhost* host = nullptr;
    if (options.port != 0)
        host = listenTo(options, info);
    if (!options.socket.empty())
        host = listenTo(options.socket, info);
    // From now on clients cause its errors; a line for each would fill a log, or stop this thread at a pipe.
    lws_set_log_level(0, nullptr);
    network.timer.emplace();
    lws_sock_file_fd_type timer;
    timer.filefd = dup(network.timer->descriptor()); // lws closes what it was given
    if (lws_adopt_descriptor_vhost(host, LWS_ADOPT_RAW_FILE_DESC, timer, kTimer, nullptr) == nullptr)
        throw std::runtime_error("libwebsockets takes no timer");
}

/// Where a browser finds the page, and where the token is.
void printPlaces(const ServeOptions& options, const std::string& token, const std::string& tokenFile) {
    if (options.port != 0)
        std::printf("%s/#%s\ntoken in %s\n", urlOf(network.names).c_str(), token.c_str(), tokenFile.c_str());
    if (!options.socket.empty())
        std::printf("socket %s\n", options.socket.c_str());
    std::printf("Space takes the drive and the force back, and gives the force again; Ctrl+C ends\n");
    std::fflush(stdout);
}

} // namespace

void stopServing() noexcept {
    stopping = 1;
    if (network.context != nullptr)
        lws_cancel_service(network.context);
}

void serve(const ServeOptions& options, const std::string& web) {
    if (const std::string problem = listenProblem(options); !problem.empty())
        throw std::runtime_error(problem);
    network.web = web;
    network.names = ownNames(options);
    const std::string token = newToken();
    TouchServer server(options, token);
    network.server = &server;
    listen(options);
    // Not before: another server that has the port keeps its file.
    const std::string tokenFile = options.port != 0 ? writeToken(token, options) : std::string();
    printPlaces(options, token, tokenFile);
    const RawTerminal terminal;
    network.timer->set(monotonicNow());
    while (stopping == 0 && lws_service(network.context, 0) >= 0) {
    }
    lws_context_destroy(std::exchange(network.context, nullptr)); // a signal may still come
    if (!tokenFile.empty())
        (void)unlink(tokenFile.c_str());
    if (!options.socket.empty())
        (void)unlink(options.socket.c_str());
}

} // namespace touchstone::server

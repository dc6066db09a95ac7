#include "server/access.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace touchstone::server {

namespace fs = std::filesystem;

namespace {

/// A folder that only we may enter.
fs::path runtimeFolder() {
    const char* given = std::getenv("XDG_RUNTIME_DIR");
    const fs::path folder = given != nullptr && *given == '/'
                                ? fs::path(given) / "touchstone"
                                : fs::temp_directory_path() / ("touchstone-" + std::to_string(getuid()));
    if (mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
        throw std::runtime_error(folder.string() + ": cannot be made");
    struct stat status {};
    if (lstat(folder.c_str(), &status) != 0 || !S_ISDIR(status.st_mode) || status.st_uid != getuid() ||
        (status.st_mode & 077) != 0)
        throw std::runtime_error(folder.string() +
                                 ": is not a folder of ours with mode 0700\n  remedy: remove it");
    return folder;
}

bool isLoopback(std::string_view address) {
    return address.starts_with("127.");
}

bool isBelow(const fs::path& root, const fs::path& file) {
    const auto [end, rest] = std::mismatch(root.begin(), root.end(), file.begin(), file.end());
    return end == root.end() && rest != file.end();
}

/// A scheme and a host with its port, in the form that browsers send: never "null", which is everybody's.
bool isOrigin(std::string_view origin) {
    const size_t scheme = origin.starts_with("http://") ? 7 : origin.starts_with("https://") ? 8 : 0;
    const std::string_view host = origin.substr(scheme);
    // Browsers leave the usual port out: with it no page's origin would ever be this one.
    const bool usual = host.ends_with(scheme == 7 ? ":80" : ":443");
    return scheme > 0 && !host.empty() && !usual &&
           host.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789.-:[]") == std::string_view::npos;
}

} // namespace

std::string newToken() {
    std::array<uint8_t, 32> bytes{};
    if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
        throw std::runtime_error("the system gives no random numbers");
    std::string text;
    for (const uint8_t byte : bytes)
        for (const int digit : {byte >> 4, byte & 15})
            text += "0123456789abcdef"[digit];
    return text;
}

std::string tokenFileName(const ServeOptions& options) {
    const bool usual = options.address == "127.0.0.1" || isAnyAddress(options.address);
    return "serve-" + (usual ? "" : options.address + "-") + std::to_string(options.port) + ".token";
}

std::string writeToken(const std::string& token, const ServeOptions& options) {
    const fs::path file = runtimeFolder() / tokenFileName(options);
    (void)unlink(file.c_str());
    const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    const bool written = descriptor >= 0 &&
                         write(descriptor, token.data(), token.size()) == static_cast<ssize_t>(token.size());
    if (descriptor >= 0)
        close(descriptor);
    if (!written)
        throw std::runtime_error(file.string() + ": the token cannot be written");
    return file.string();
}

bool sameToken(std::string_view given, std::string_view token) noexcept {
    unsigned differing = given.size() == token.size() ? 0 : 1;
    for (size_t i = 0; i < token.size(); ++i)
        differing |= static_cast<unsigned>((i < given.size() ? given[i] : 0) ^ token[i]);
    return differing == 0;
}

OwnNames ownNames(const ServeOptions& options) {
    OwnNames own{options.names, options.port, !options.certificate.empty(), options.origins};
    if (!isAnyAddress(options.address))
        own.hosts.push_back(options.address);
    if (isAnyAddress(options.address) || isLoopback(options.address)) {
        own.hosts.emplace_back("127.0.0.1");
        own.hosts.emplace_back("localhost");
    }
    return own;
}

std::string urlOf(const OwnNames& names) {
    return (names.tls ? "https://" : "http://") + names.hosts.front() + ":" + std::to_string(names.port);
}

bool isAnyAddress(std::string_view address) {
    return address == "0.0.0.0";
}

std::string listenProblem(const ServeOptions& options) {
    in_addr parsed{};
    if (inet_pton(AF_INET, options.address.c_str(), &parsed) != 1)
        return "--listen " + options.address + ": is no IPv4 address";
    if (options.certificate.empty() != options.key.empty())
        return "--certificate and --key need each other";
    if (options.certificate.empty() && !isLoopback(options.address) && options.port != 0) {
        const std::string port = std::to_string(options.port);
        return "--listen " + options.address +
               ": is not on loopback, and without TLS everybody on the way could drive the device\n"
               "  remedy: --certificate FILE --key FILE; or stay on 127.0.0.1, and forward the port there "
               "(ssh "
               "-L " +
               port + ":127.0.0.1:" + port + " THIS_MACHINE) or put a TLS proxy before it (stunnel)";
    }
    for (const std::string& origin : options.origins)
        if (!isOrigin(origin))
            return "--origin " + origin +
                   ": is no origin as browsers send it\n  remedy: http://localhost:8000";
    struct stat status {};
    if (!options.key.empty() && (stat(options.key.c_str(), &status) != 0 || (status.st_mode & 07) != 0))
        return "--key " + options.key + ": everybody may read it\n  remedy: chmod 600 " + options.key;
    return {};
}

bool isOwnHost(std::string_view host, const OwnNames& names) {
    const bool usual = names.port == (names.tls ? 443 : 80); // browsers leave it out
    const std::string end = ":" + std::to_string(names.port);
    return std::ranges::any_of(
        names.hosts, [&](const std::string& own) { return host == own + end || (usual && host == own); });
}

bool isOwnOrigin(std::string_view origin, const OwnNames& names) {
    const std::string_view scheme = names.tls ? "https://" : "http://";
    return origin.empty() || std::ranges::find(names.origins, origin) != names.origins.end() ||
           (origin.starts_with(scheme) && isOwnHost(origin.substr(scheme.size()), names));
}

std::string fileBelow(const std::string& root, const std::string& name) {
    std::error_code problem;
    const fs::path base = fs::canonical(root, problem);
    if (problem || name.find('\0') != std::string::npos)
        return {};
    const fs::path file = fs::canonical(base / name, problem);
    return !problem && isBelow(base, file) && fs::is_regular_file(file, problem) ? file.string()
                                                                                 : std::string();
}

std::string newFileBelow(const std::string& root, const std::string& name) {
    std::error_code problem;
    const fs::path base = fs::canonical(root, problem);
    if (problem || name.find('\0') != std::string::npos)
        return {};
    const fs::path given = base / name;
    const fs::path folder = fs::canonical(given.parent_path(), problem);
    const fs::path file = folder / given.filename();
    if (problem || given.filename().empty() || !isBelow(base, file) ||
        fs::exists(fs::symlink_status(file, problem)))
        return {};
    return file.string();
}

} // namespace touchstone::server

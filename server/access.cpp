#include "server/access.h"

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

bool isBelow(const fs::path& root, const fs::path& file) {
    const auto [end, rest] = std::mismatch(root.begin(), root.end(), file.begin(), file.end());
    return end == root.end() && rest != file.end();
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

std::string writeToken(const std::string& token, int port) {
    const fs::path file = runtimeFolder() / ("serve-" + std::to_string(port) + ".token");
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

bool isOwnHost(std::string_view host, int port) {
    const std::string end = ":" + std::to_string(port);
    return host == "127.0.0.1" + end || host == "localhost" + end;
}

bool isOwnOrigin(std::string_view origin, int port) {
    constexpr std::string_view kScheme = "http://";
    return origin.empty() || (origin.starts_with(kScheme) && isOwnHost(origin.substr(kScheme.size()), port));
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

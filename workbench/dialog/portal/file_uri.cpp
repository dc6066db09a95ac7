#include "workbench/dialog/portal/file_uri.h"

#include <charconv>

namespace touchstone {

std::optional<std::string> pathOfUri(std::string_view uri) {
    constexpr std::string_view kScheme = "file://", kHost = "localhost";
    if (!uri.starts_with(kScheme))
        return std::nullopt;
    uri.remove_prefix(kScheme.size());
    if (uri.starts_with(kHost))
        uri.remove_prefix(kHost.size());
    if (!uri.starts_with('/'))
        return std::nullopt;
    std::string path;
    for (size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] != '%') {
            path += uri[i];
            continue;
        }
        const std::string_view code = uri.substr(i + 1, 2);
        unsigned value = 0;
        const auto [end, problem] = std::from_chars(code.data(), code.data() + code.size(), value, 16);
        if (code.size() != 2 || problem != std::errc() || end != code.data() + 2)
            return std::nullopt;
        path += static_cast<char>(value);
        i += 2;
    }
    if (path.find('\0') != std::string::npos)
        return std::nullopt;
    return path;
}

} // namespace touchstone

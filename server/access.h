#pragma once
// Who may connect: the token, and where a request says that it comes from.

#include <string>
#include <string_view>

namespace touchstone::server {

/// 256 random bits, in hexadecimal.
[[nodiscard]] std::string newToken();

/// Writes the token to touchstone/serve-PORT.token (mode 0600) in the runtime directory ($XDG_RUNTIME_DIR,
/// else a folder of mode 0700 under the temporary one); returns the file. Throws std::runtime_error.
[[nodiscard]] std::string writeToken(const std::string& token, int port);

/// In a time that does not depend on where they differ.
[[nodiscard]] bool sameToken(std::string_view given, std::string_view token) noexcept;

/// The Host header names this machine's loopback and our port: no name that somebody's DNS resolves to it.
[[nodiscard]] bool isOwnHost(std::string_view host, int port);
/// The Origin header, where a browser sends one, is our own page.
[[nodiscard]] bool isOwnOrigin(std::string_view origin, int port);

/// `name` below `root`, links resolved; empty where it is outside or does not exist.
[[nodiscard]] std::string fileBelow(const std::string& root, const std::string& name);
/// The same for a file that need not exist, in a folder that does.
[[nodiscard]] std::string newFileBelow(const std::string& root, const std::string& name);

} // namespace touchstone::server

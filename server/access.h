#pragma once
// Who may connect: the token, where a request says that it comes from, and where the server may listen.

#include "server/serve_options.h"

#include <string>
#include <string_view>
#include <vector>

namespace touchstone::server {

/// 256 random bits, in hexadecimal.
[[nodiscard]] std::string newToken();

/// "serve-PORT.token" where clients reach the server at 127.0.0.1, else "serve-ADDRESS-PORT.token": servers
/// at one port of different addresses have each its own.
[[nodiscard]] std::string tokenFileName(const ServeOptions& options);
/// Writes the token to touchstone/ and that name (mode 0600) in the runtime directory ($XDG_RUNTIME_DIR,
/// else a folder of mode 0700 under the temporary one); returns the file. Throws std::runtime_error.
[[nodiscard]] std::string writeToken(const std::string& token, const ServeOptions& options);

/// In a time that does not depend on where they differ.
[[nodiscard]] bool sameToken(std::string_view given, std::string_view token) noexcept;

/// How clients call this server.
struct OwnNames {
    std::vector<std::string> hosts; ///< names and addresses, without the port
    int port = 0;
    bool tls = false;
    std::vector<std::string> origins; ///< of other servers' pages that may connect
};
[[nodiscard]] OwnNames ownNames(const ServeOptions& options);
/// Of the page.
[[nodiscard]] std::string urlOf(const OwnNames& names);

/// Why the server must not listen as it is asked to: off loopback without TLS, TLS without a key, a key that
/// everybody may read, an origin that no browser sends. Empty: it may.
[[nodiscard]] std::string listenProblem(const ServeOptions& options);
/// All of the machine's.
[[nodiscard]] bool isAnyAddress(std::string_view address);

/// The Host header is a name of ours with our port: no other name that somebody's DNS resolves to us.
[[nodiscard]] bool isOwnHost(std::string_view host, const OwnNames& names);
/// The Origin header, where a browser sends one, is our own page or one that may connect.
[[nodiscard]] bool isOwnOrigin(std::string_view origin, const OwnNames& names);

/// `name` below `root`, links resolved; empty where it is outside or does not exist.
[[nodiscard]] std::string fileBelow(const std::string& root, const std::string& name);
/// The same for a file that need not exist, in a folder that does.
[[nodiscard]] std::string newFileBelow(const std::string& root, const std::string& name);

} // namespace touchstone::server

#pragma once
// The network around TouchServer: WebSockets and the page, by libwebsockets.

#include "server/touch_server.h"

#include <string>

namespace touchstone::server {

/// Serves until `stopServing`; `web`: folder of the page. One thread for all connections; the servo has its
/// own. Once a process. Throws std::runtime_error and ts::Error.
void serve(const ServeOptions& options, const std::string& web);

/// Async-signal-safe.
void stopServing() noexcept;

} // namespace touchstone::server

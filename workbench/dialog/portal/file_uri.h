#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace touchstone {

/// The absolute path that a file: URI names (RFC 8089: no host, or localhost), its percent codes decoded.
/// Nothing for any other URI, a code that is none, or a NUL.
[[nodiscard]] std::optional<std::string> pathOfUri(std::string_view uri);

} // namespace touchstone

#pragma once

#include <string>

namespace touchstone {

/// hidapi's wide text as UTF-8; null is empty.
[[nodiscard]] std::string utf8(const wchar_t* text);

} // namespace touchstone

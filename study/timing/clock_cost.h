#pragma once

#include <cstdint>

namespace touchstone {

/// Time of two clock readings, ns: part of every time measured with them.
[[nodiscard]] int64_t clockCostNs();

} // namespace touchstone

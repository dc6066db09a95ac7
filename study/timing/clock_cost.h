#pragma once

#include <cstdint>

namespace touchstone {

/// What reading the clock twice costs, ns: part of every time that is measured so.
[[nodiscard]] int64_t clockCostNs();

} // namespace touchstone

#pragma once

#include "devices/link/little_endian.h"

namespace touchstone {

/// Result of parsing one report.
enum class ReportVerdict : uint8_t {
    Reading,  ///< carries the position of the hand
    Ignored,  ///< well formed, without a position
    Repeated, ///< duplicate or out of order
    Malformed
};

} // namespace touchstone

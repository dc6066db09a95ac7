#pragma once

#include "devices/link/little_endian.h"

namespace touchstone {

/// What a parser makes of one report.
enum class ReportVerdict : uint8_t {
    Reading,  ///< says where the hand is
    Ignored,  ///< well formed, but says nothing of the hand
    Repeated, ///< seen before, or overtaken
    Malformed
};

} // namespace touchstone

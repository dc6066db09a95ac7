#pragma once

#include "haptics/haptic_settings.h"

#include <nlohmann/json.hpp>

namespace touchstone {

/// Every setting as `--set` would take it.
[[nodiscard]] nlohmann::ordered_json settingsJson(const HapticSettings& settings);

} // namespace touchstone

#pragma once

#include "devices/plant/plant.h"
#include "haptics/settings/haptic_settings.h"

#include <nlohmann/json_fwd.hpp>

namespace touchstone {

/// Every setting in the syntax of `--set`.
[[nodiscard]] nlohmann::ordered_json settingsJson(const HapticSettings& settings);
/// The parameters of a simulated device in a hand, and its energies in J.
[[nodiscard]] nlohmann::ordered_json plantJson(const Plant& plant);

} // namespace touchstone

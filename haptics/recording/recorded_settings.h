#pragma once
// Settings and limits as named numbers: exact to the last bit, and readable by versions with fewer or more of
// them.

#include "engine/device_io/device_io.h"
#include "haptics/recording/byte_stream.h"
#include "haptics/settings/haptic_settings.h"

#include <optional>

namespace touchstone {

/// Count (u16), then for each: name (u32 length, text) and value (f64; choices by their place among
/// the words of settingFields, switches 0 or 1).
void putSettings(ByteWriter& bytes, const HapticSettings& settings);
/// Null: no number.
void putLimits(ByteWriter& bytes, const std::optional<DeviceLimits>& limits);

/// A missing setting keeps its default. Throws Error for a name unknown to this version and for a value that
/// `--set` would refuse.
[[nodiscard]] HapticSettings getSettings(ByteReader& bytes);
/// Null where there is no number.
[[nodiscard]] std::optional<DeviceLimits> getLimits(ByteReader& bytes);

} // namespace touchstone

#pragma once

#include "haptics/tick/haptic_step.h"

#include <string>
#include <string_view>

namespace touchstone {

/// Header line of TICKS.csv (docs/commands.md, touch).
inline constexpr std::string_view kTickCsvHeader =
    "t,hip_x,hip_y,hip_z,proxy_x,proxy_y,proxy_z,normal_x,normal_y,normal_z,force_x,force_y,force_z,contacts,"
    "friction_state,penetration,step_ns,command_x,command_y,command_z\n";

/// With `pad`, two more columns: where the finger's pad touches, m along and across, 0 without contact.
[[nodiscard]] std::string tickCsvHeader(bool pad);
/// Them, to the row appended last.
void appendPadPlace(std::string& text, const DeviceSample& sample, const HapticOutput& output);

/// Appends one row: SI units, workspace frame, every double in the shortest form that reads back bitwise
/// equal; friction_state is 0 free, 1 sticking, 2 sliding.
void appendTickRow(std::string& text, double time, const HapticOutput& output, int64_t stepNs);

} // namespace touchstone

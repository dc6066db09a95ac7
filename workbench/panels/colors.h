#pragma once
// Colours of status lamps, notices and marks.

#include <imgui.h>

namespace touchstone {

constexpr ImU32 kGreen = IM_COL32(80, 200, 120, 255), kAmber = IM_COL32(240, 180, 60, 255),
                kRed = IM_COL32(235, 75, 65, 255), kBlue = IM_COL32(97, 173, 255, 255),
                kFailure = IM_COL32(242, 128, 107, 255), kSuccess = IM_COL32(153, 204, 166, 255); // texts

} // namespace touchstone

#pragma once

#include <cstdint>
#include <vector>

namespace touchstone {

/// A tooltip with the bins of histogramOf (tick_statistics.h) on a logarithmic count scale, so that one late
/// tick in thousands is visible. Main thread, within an ImGui frame. `title` and `note`: a line above and
/// below.
void showTimeHistogram(const char* title, const char* note, const std::vector<uint64_t>& bins, float scale);

} // namespace touchstone

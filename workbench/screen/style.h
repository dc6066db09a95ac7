#pragma once

namespace touchstone {

/// Colours, spacing and the fonts: the usual one, and the last in the atlas, a large one (Inter where it is
/// installed), `scale` window coordinates for one unit of layout. After the ImGui context exists and before
/// its first frame. Main thread.
void applyStyle(float scale);

} // namespace touchstone

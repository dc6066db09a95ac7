#pragma once

namespace touchstone {

/// Colours, spacing and the font (Inter where it is installed), for a screen of this density. After the ImGui
/// context exists and before its first frame. Main thread.
void applyStyle(float contentScale);

} // namespace touchstone

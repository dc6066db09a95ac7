#pragma once

namespace touchstone {

/// Colours, spacing and fonts: the default font, and, last in the atlas, a large one (Inter where installed);
/// `scale`: window coordinates per layout unit. After the ImGui context exists, between frames, and before
/// the fonts are uploaded; may be called again for another scale. Main thread.
void applyStyle(float scale);

} // namespace touchstone

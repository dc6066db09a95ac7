#pragma once

#include "engine/scene/image.h"

#include <functional>

namespace touchstone {

/// Draws what `draw` puts into Dear ImGui's background, in units of the picture's pixels, over an opaque
/// picture of RGBA bytes, without a device: for what lies over the model in a picture of any size. Fonts are
/// made for `scale` pixels per layout unit (16 at most). Leaves the current ImGui context, which may be
/// within a frame, as it is. Main thread.
void drawGui(PixelData& picture, float scale, const std::function<void()>& draw);

} // namespace touchstone

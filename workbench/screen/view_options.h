#pragma once

#include "renderer/view.h"

#include <optional>

namespace touchstone {

/// Where the camera is asked to go. The sides are those of the workspace: front is +z, where the user sits.
enum class CameraMove : uint8_t { Fit, Front, Back, Right, Left, Top, Bottom, Probe };

/// What of a tick is drawn over the model.
struct ShownOverlays {
    bool probe = true;    ///< HIP, proxy and the line between them
    bool shadow = true;   ///< the probe's, on the surface
    bool force = true;    ///< arrow, 40 mm for a newton
    bool planes = true;   ///< active constraint planes
    bool friction = true; ///< stiction point and friction cone
    bool normal = false;  ///< of the felt surface: shaded, textured
};

/// How the model is looked at: what menu and keys change, and what the picture follows. Plain values of the
/// main thread.
struct ViewOptions {
    ViewMode mode = ViewMode::Shaded;
    ShownOverlays overlays;
    bool turntable = false;         ///< the camera goes round by itself
    bool magnifier = false;         ///< a second small view that follows the probe
    bool freeHand = false;          ///< the mouse moves its hand in space, not over what it points at
    double press = 0.6;             ///< N with which the mouse presses on what it points at
    bool savePicture = false;       ///< asked for in this frame: the picture as it is in the window, as PNG
    std::optional<CameraMove> move; ///< asked for in this frame
};

} // namespace touchstone

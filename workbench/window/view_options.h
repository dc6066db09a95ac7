#pragma once

#include "renderer/view.h"

#include <optional>

namespace touchstone {

/// Where the camera is asked to go. The sides are those of the workspace: front is +z, where the user sits.
enum class CameraMove : uint8_t { Fit, Front, Back, Right, Left, Top, Bottom, Probe };

/// How the model is looked at: what menu and keys change, and what the picture follows. Plain values of the
/// main thread.
struct ViewOptions {
    ViewMode mode = ViewMode::Shaded;
    bool turntable = false;         ///< the camera goes round by itself
    std::optional<CameraMove> move; ///< asked for in this frame
};

} // namespace touchstone

#pragma once

#include "renderer/view.h"
#include "workbench/screen/field_slice.h"

#include <glm/glm.hpp>

#include <optional>

namespace touchstone {

/// Camera moves. The sides are those of the workspace: front is +z, where the user sits.
enum class CameraMove : uint8_t { Fit, Front, Back, Right, Left, Top, Bottom, Probe };

/// Overlays of a tick.
struct ShownOverlays {
    bool probe = true;    ///< HIP, proxy and the line between them
    bool shadow = true;   ///< the probe's, on the surface
    bool force = true;    ///< arrow, 40 mm per newton
    bool planes = true;   ///< active constraint planes
    bool friction = true; ///< stiction point and friction cone
    bool normal = false;  ///< of the felt surface: shaded, textured
};

/// How the model is displayed: changed by menu and keys. Plain values of the main thread.
struct ViewOptions {
    ViewMode mode = ViewMode::Shaded;
    ShownOverlays overlays;
    ScenePart part;                 ///< to be seen and felt
    bool wireframe = false;         ///< the triangles' edges over the surface
    bool grid = false;              ///< on the ground beneath the model
    FieldSlice slice;               ///< of what is felt as a field
    bool axes = true;               ///< in the picture's corner, to look along
    bool orthographic = false;      ///< projection
    bool turntable = false;         ///< the camera orbits by itself
    bool magnifier = false;         ///< magnified inset that follows the probe
    bool freeHand = false;          ///< the mouse moves its hand in space, not over the pointed surface
    double press = 0.6;             ///< N, press force of the mouse
    bool savePicture = false;       ///< requested in this frame: what the window shows of the model, as PNG
    glm::ivec2 pictureSize{0};      ///< pixels of it; 0: as large as the window shows it
    std::optional<CameraMove> move; ///< requested in this frame
};

} // namespace touchstone

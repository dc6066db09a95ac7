#pragma once

#include <atomic>
#include <functional>
#include <string>

namespace touchstone {

/// Which images to decode: of these only what a material of a placed mesh needs.
struct ImageUse {
    bool visual = true; ///< base colour, metallic-roughness, normal, occlusion, emissive
    /// Normal and height maps that are felt, friction, stiffness, damping, and roughness to derive friction.
    bool haptic = true;
};

struct LoadOptions {
    ImageUse images;
    /// Called from the loading thread with 0..1 and what is being done (a literal, valid for ever). May be
    /// empty.
    std::function<void(double fraction, const char* what)> progress;
    /// MaterialPatches as text (engine/save/material_patch.h) that the file is read with; empty: none.
    std::string edits;
    /// Set it to stop: loadScene then throws Error with problem "cancelled". May be null.
    const std::atomic<bool>* cancel = nullptr;
};

} // namespace touchstone

#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace touchstone {

class Volume; // engine/volume/volume.h

/// The images to decode: of these, only those that a material of a placed mesh needs.
struct ImageUse {
    bool visual = true; ///< base colour, metallic-roughness, normal, occlusion, emissive
    /// Normal and height maps for touch, friction, stiffness, damping, and roughness to derive friction.
    bool haptic = true;
};

struct LoadOptions {
    ImageUse images;
    /// Called from the loading thread with 0..1 and the current activity (a literal with static lifetime).
    /// May be empty.
    std::function<void(double fraction, const char* what)> progress;
    /// MaterialPatches as text (engine/save/material_patch.h) that are applied to the file; empty: none.
    std::string edits;
    /// Of a volume: the value at its surface; none: that of the edits, else Volume::defaultIso.
    std::optional<double> iso;
    /// The animation that plays, by its name or index in the file; none: the first that moves something.
    std::optional<std::string> animation;
    /// The volume of the file, where it has been read before: it is not read again. May be null.
    std::shared_ptr<const Volume> volume;
    /// Set it to stop: loadScene then throws Error with problem "cancelled". May be null.
    const std::atomic<bool>* cancel = nullptr;
};

} // namespace touchstone

#pragma once
// glTF and GLB in: read, validate, build. Any thread; throws touchstone::Error.

#include "engine/scene/scene.h"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace touchstone {

/// Which images to decode: of these only what a material of a placed mesh needs (DESIGN §7).
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

/// Reads the file, follows its URIs inside its own folder, validates everything before use and builds the
/// immutable scene. Broken images become warnings and grey; broken geometry, structure or references throw.
[[nodiscard]] ScenePtr loadScene(const std::filesystem::path& path, const LoadOptions& options = {});

/// The same for a .gltf or .glb that is already in memory; its URIs are relative to `folder`.
[[nodiscard]] ScenePtr loadSceneFromMemory(std::vector<uint8_t> bytes, const std::filesystem::path& folder,
                                           const LoadOptions& options = {});

} // namespace touchstone

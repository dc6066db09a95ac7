#pragma once
// Identifies the touched scene: its file, and whether a given scene is the same.

#include "engine/device_io/device_io.h"
#include "engine/scene/scene_part.h"
#include "haptics/scene/haptic_scene.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace touchstone {

struct SceneIdentity {
    std::string path;         ///< as the user gave it
    std::string absolutePath; ///< empty where there is no file
    bool generated = false;   ///< the program's own default scene
    uint64_t fileSize = 0;    ///< bytes; of the file itself, not of those that it refers to
    uint64_t fileHash = 0;    ///< Hash64 of its bytes
    uint64_t feltHash = 0;    ///< of all data that touch reads: see feltHash
    /// Changes since the file was read: MaterialPatches as JSON (engine/save), and the value at a volume's
    /// surface as its member "iso". Empty: none.
    std::string edits;
    ScenePart part; ///< what was seen and felt of it
    Fit fit = Fit::None;
    /// Of the device that touched it; only in recordings of format 1, whose ticks do not have them.
    std::optional<DeviceLimits> limits;
};

/// Hash of everything in a compiled scene that a tick reads: meshes, poses, materials, maps, and the
/// animation that plays in `source`. Two scenes of one hash feel the same; appearance is not included. Not
/// for the servo thread: reads every vertex and texel (0.1 s for a million triangles).
[[nodiscard]] uint64_t feltHash(const HapticScene& scene, const Scene& source);

/// Reads the file again, but for a volume, which is known as it was when it was read: a file may have a
/// gigabyte, and every value at the surface is a scene. A file that no longer exists has size and hash 0.
[[nodiscard]] SceneIdentity identify(const HapticScene& scene, const Scene& source, Fit fit);

} // namespace touchstone

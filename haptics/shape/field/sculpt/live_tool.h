#pragma once
// The tool in a hand that sculpts, and the journal of what was made with it.

#include "haptics/shape/field/sculpt/sculpt_tool.h"

#include <glm/glm.hpp>

#include <cstdint>

namespace touchstone {

/// The device's first button, as a bit of DeviceSample::buttons: the tool works while it is held.
inline constexpr uint32_t kSculptButton = 1u << 0;

/// Part of a tick's input. Lengths in metres, workspace.
struct LiveTool {
    bool active = false; ///< false: the button has no meaning
    bool held = false;   ///< as if the button were
    SculptTool tool = SculptTool::Carve;
    int32_t object = -1; ///< HapticScene::objects: sculpted where the hand touches no field; -1: none
    int32_t stamp = -1;  ///< HapticScene::objects, of Stamp and Imprint
    double radius = 0.005;
    double strength = 1.0, falloff = 0.0; ///< as those of a Dab
    /// N for each m^3/s that the tool takes out of the solid: 2 N for a ball of 5 mm at 0.1 m/s, half in the
    /// solid.
    double resistance = 5e5;
    glm::vec3 color{0.8f, 0.05f, 0.03f}; ///< of Paint, as that of a Dab
    bool operator==(const LiveTool&) const = default;
};

/// Shape and Restore are the halves of a Dab (Sculptor): what the hand made is felt before distances are
/// restored. Preview is what it makes meanwhile: felt at once, and made again after the Restore.
enum class SculptEntryKind : uint8_t { Begin, Dab, Undo, Redo, Shape, Restore, Preview };
inline constexpr SculptEntryKind kLastSculptEntryKind = SculptEntryKind::Preview;

/// An entry of the journal: numbers alone, so that it goes through a ring and into a recording.
struct SculptEntry {
    SculptEntryKind kind = SculptEntryKind::Dab;
    SculptTool tool = SculptTool::Carve;
    int32_t object = -1, stamp = -1; ///< HapticScene::objects; not of Undo and Redo
    uint64_t tick = 0;               ///< in which the hand made it; 0: no hand did
    uint32_t root =
        0; ///< on the servo's way alone: the scene (TickRecord::root) in which it was made; 0: any
    glm::dvec3 centre{0.0}, motion{0.0}; ///< of a Dab or Shape, with the rest: the object's frame and unit
    double radius = 0.0, strength = 1.0, falloff = 0.0;
    glm::vec3 color{1.0f}; ///< of Paint
    bool operator==(const SculptEntry&) const = default;
};

} // namespace touchstone

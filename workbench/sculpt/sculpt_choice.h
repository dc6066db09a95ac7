#pragma once

#include "haptics/shape/field/sculpt/live_tool.h"

#include <string>

namespace touchstone {

/// The tool shelf, as the user set it.
struct SculptChoice {
    bool on = false;
    SculptTool tool = SculptTool::Carve;
    double radius = 0.005;                ///< m, workspace
    double strength = 1.0, falloff = 0.0; ///< as those of LiveTool
    glm::vec3 color = LiveTool{}.color;   ///< of Paint: linear RGB, 0..1
    std::string stamp;                    ///< an object of the scene; empty: the first
    // Of this frame:
    bool inverts = false, smooths = false;           ///< Ctrl and Shift
    bool held = false;                               ///< the key is, in place of a button of the hand
    bool undo = false, redo = false, saveAs = false; ///< asked for; cleared by the code that handles them
};

inline constexpr double kMinSculptRadius = 5e-4, kMaxSculptRadius = 0.05; // m

/// The tool in effect: Shift smooths, Ctrl inverts.
[[nodiscard]] inline SculptTool toolOf(const SculptChoice& choice) {
    return choice.smooths ? SculptTool::Smooth : choice.inverts ? infoOf(choice.tool).inverse : choice.tool;
}

/// The colour in effect: Ctrl takes colour off.
[[nodiscard]] inline glm::vec3 paintOf(const SculptChoice& choice) {
    return choice.inverts ? glm::vec3(1.0f) : choice.color;
}

} // namespace touchstone

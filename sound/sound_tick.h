#pragma once

#include <glm/glm.hpp>

namespace touchstone {

/// What one tick of the servo is to the ear: what a device knows of it, turned and placed as the hand
/// is in the workspace (clutch and zoom change where the hand is, not what it hears).
struct SoundTick {
    double dt = 1e-3;         ///< s since the tick before
    glm::dvec3 position{0.0}; ///< m, of the hand, workspace
    glm::dvec3 force{0.0};    ///< N, workspace: the command, what a device would push with, after safety
    bool handKnown = true;    ///< false: `position` says nothing
};

} // namespace touchstone

#pragma once

#include <glm/glm.hpp>

namespace touchstone {

/// A servo tick as input of the sound: the data of a device, mapped to the workspace (clutch and zoom change
/// the hand's position, not the sound).
struct SoundTick {
    double dt = 1e-3;         ///< s since the previous tick
    glm::dvec3 position{0.0}; ///< m, of the hand, workspace
    glm::dvec3 force{0.0};    ///< N, workspace: the commanded force, after safety
    double impact = 0.0;      ///< N s, of bodies that met in the tick (docs/sound.md, Impacts)
    bool handKnown = true;    ///< false: `position` is invalid
};

} // namespace touchstone

#pragma once

#include <glm/glm.hpp>

namespace touchstone {

/// A servo tick as input of the sound: the data of a device, mapped to the workspace (clutch and zoom change
/// the hand's position, not the sound).
struct SoundTick {
    double dt = 1e-3;         ///< s since the previous tick
    glm::dvec3 position{0.0}; ///< m, of the hand, workspace
    glm::dvec3 force{0.0};    ///< N, workspace: the commanded force, after safety
    bool handKnown = true;    ///< false: `position` is invalid
};

} // namespace touchstone

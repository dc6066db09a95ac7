#pragma once

#include <glm/glm.hpp>

namespace touchstone {

/// What one tick of the servo is to the ear: what a device knows of it, in the device's frame.
struct SoundTick {
    double dt = 1e-3;         ///< s since the tick before
    glm::dvec3 position{0.0}; ///< m, of the hand
    glm::dvec3 force{0.0};    ///< N, the command: what a device would push with, after safety
    bool handKnown = true;    ///< false: `position` says nothing
};

} // namespace touchstone

#pragma once

#include <glm/glm.hpp>

namespace touchstone::body {

/// What a hand does to an object in a tick. Workspace.
struct HandPush {
    glm::dvec3 point{0.0};    ///< m
    glm::dvec3 force{0.0};    ///< N, on the object
    glm::dvec3 velocity{0.0}; ///< m/s, of the hand
    double stiffness = 0.0;   ///< N/m, of the contact that exerts it
    double most = 0.0;        ///< N, what its device can exert
    double wanted = 1.0;      ///< the spring's force over `force`; above 1 where it is beyond `most`
};

} // namespace touchstone::body

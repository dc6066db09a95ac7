#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace touchstone {

/// The object that a hand holds, and where.
struct Grasp {
    int object = -1;                         ///< HapticScene::objects; -1: none
    glm::dvec3 place{0.0};                   ///< that the hand took hold of, object frame
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0}; ///< of the object in the workspace, when it was taken
};

} // namespace touchstone

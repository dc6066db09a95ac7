#pragma once

#include "haptics/proxy/sub_goal.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>

namespace touchstone {

/// A place where the proxy touches.
struct Contact {
    glm::dvec3 normal{0.0}; ///< unit, from the surface to the proxy's centre, anchor frame
    glm::dvec3 point{0.0};  ///< on the surface, anchor frame
    double gap = 0.0;       ///< distance minus radius, object units
    int object = -1;        ///< HapticScene::objects
    uint32_t triangle = 0;  ///< of that object
    uint32_t candidate = 0; ///< of the cache, until it gathers anew; MeshProxy's
};

/// Where the last move ended and what holds the proxy there.
struct ProxyRest {
    static constexpr size_t kMaxContacts = 64;
    std::array<Contact, kMaxContacts> contacts;
    std::array<ConstraintPlane, kMaxContacts> planes;       ///< of the contacts, relative to the proxy
    std::array<ConstraintPlane, kMaxContacts> shadedPlanes; ///< the same with interpolated normals
    uint32_t contactCount = 0;
    SubGoal hold;       ///< which planes hold the proxy from its goal; indices into contacts
    SubGoal shadedHold; ///< the same of the shaded planes, where two-pass shading came to rest
                        ///< (DeviceState::shaded)
    uint32_t iterations = 0;
    uint32_t flags = 0; ///< TickFlag bits
};

} // namespace touchstone

#pragma once

#include "haptics/shape/contact.h"
#include "haptics/solve/sub_goal.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>

namespace touchstone {

/// Where the last move ended, its contacts and the active set.
struct SolveResult {
    static constexpr size_t kMaxContacts = 64;
    std::array<Contact, kMaxContacts> contacts;
    std::array<ConstraintPlane, kMaxContacts> planes;       ///< of the contacts, relative to the proxy
    std::array<ConstraintPlane, kMaxContacts> shadedPlanes; ///< the same with interpolated normals
    uint32_t contactCount = 0;
    SubGoal activeSet;       ///< the planes that hold the proxy back from its goal; indices into contacts
    SubGoal shadedActiveSet; ///< the same for the shaded planes, if two-pass shading came to rest
                             ///< (DeviceState::shaded)
    uint32_t iterations = 0;
    uint32_t flags = 0; ///< TickFlag bits
};

} // namespace touchstone

#pragma once
// What the stages of one hand's tick read.

#include "engine/device_io/device_io.h"
#include "engine/math/object_motion.h"
#include "haptics/force/contact_loads.h"
#include "haptics/settings/haptic_settings.h"

namespace touchstone {

class PersistentTextures;
struct DentPress; // haptics/surface/press_dents.h

/// Everything outside of the hand that the stages of its tick read.
struct HandTick {
    const HapticScene& scene;
    const HapticSettings& settings;
    const DeviceLimits& limits; ///< of the hand's device
    ObjectMotions motions;      ///< one per object, also where nothing moves
    bool moving = false;        ///< WorldState moves the objects
    bool still = false;         ///< WorldState::still: none of them moved
    double dt = 1e-3;           ///< s
    double zoom = 1.0;          ///< workspace metres for one device metre
    /// Filled where the world collects reactions; else null.
    ContactForces* parts = nullptr;
    PersistentTextures* textures = nullptr; ///< the world's; null: none
    DentPress* dents = nullptr;             ///< null where nothing gives way
};

} // namespace touchstone

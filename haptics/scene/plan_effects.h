#pragma once
// Why each effect of a material is on or off, and its memory. For the compiler of haptic scenes only.

#include "haptics/scene/haptic_scene.h"

namespace touchstone {

/// The parts of a material's effects that its objects determine.
struct MaterialUse {
    bool placed = false; ///< some instance with triangles has the material
    bool field =
        false; ///< its objects are felt as distance fields, which have neither coordinates nor attributes
    bool smooth = false, heights = false, stiffness = false, damping = false, friction = false;
    AttributeBytes bytes;

    void add(const HapticObject& object);
};

/// Appends all effects of one material to the plan.
void planMaterial(int index, const Material& material, const HapticMaterialData& data, const MaterialUse& use,
                  EffectPlan& plan);

} // namespace touchstone

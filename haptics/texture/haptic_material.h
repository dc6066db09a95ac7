#pragma once

#include "engine/scene/local_deformation.h"
#include "engine/scene/scene.h"
#include "haptics/settings/haptic_settings.h"
#include "haptics/texture/haptic_map.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

namespace touchstone {

namespace program {
struct FeltProgram; // haptics/program/felt_program.h
}

/// A map that scales a factor between `min` (black) and `max` (white).
struct HapticFactor {
    HapticMap map;
    double min = 0.0, max = 1.0;
};

/// A material as the step reads it: values resolved, maps built. NaN: not specified by the material.
struct HapticMaterialData {
    double stiffness = NAN;                             ///< N/m
    double damping = NAN;                               ///< N·s/m
    double staticFriction = 0.0, dynamicFriction = 0.0; ///< 1; dynamic <= static
    double viscousFriction = 0.0;                       ///< N·s/m
    HapticMap normal;                                   ///< tangent-space xyz as stored, 0..1
    double normalScale = 1.0;                           ///< glTF's scale times normalTextureInfluence
    HapticMap height;                                   ///< 0..1
    double heightScale = 0.0;                           ///< model metres, black to white
    double heightMid = 0.5;                             ///< value of the height map that lies on the mesh
    HapticFactor friction, stiffnessMap, dampingMap;
    std::shared_ptr<const program::FeltProgram> program; ///< null: none
    LocalDeformation deformation;
    /// The material's forceShading, resolved: auto is TwoPass, never Material.
    ShadingMode shading = ShadingMode::TwoPass;
    /// Neither the material nor any of its objects has a map, a vertex attribute, friction, a viscous term or
    /// a dent: stage 5 reads nothing. Resolved with the plan.
    bool plain = false;

    [[nodiscard]] bool textured() const { return !normal.empty() || (!height.empty() && heightScale != 0.0); }
    [[nodiscard]] uint64_t memoryBytes() const {
        return normal.memoryBytes() + height.memoryBytes() + friction.map.memoryBytes() +
               stiffnessMap.map.memoryBytes() + dampingMap.map.memoryBytes();
    }
};

/// A source material and its resolved form, whose maps are reused where they are unchanged.
struct SettledMaterial {
    const Material* material = nullptr;
    const HapticMaterialData* data = nullptr;
};

/// Resolves `material`, number `index` of the scene; its meshes have the texture coordinates `sets`. Appends
/// messages for the user to `warnings`. Reads only the scene's images.
[[nodiscard]] HapticMaterialData buildHapticMaterial(const Scene& scene, const Material& material,
                                                     size_t index, const CoordinateSets& sets,
                                                     std::vector<Warning>& warnings,
                                                     const SettledMaterial& before = {});

} // namespace touchstone

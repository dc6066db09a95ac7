#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace touchstone {

enum class Effect : uint8_t {
    ForceShading,
    NormalMap,
    HeightMap,
    Friction,
    ViscousFriction,
    Damping,
    VaryingStiffness, ///< by map or vertex
    Program,          ///< a haptic program
    LocalDeformation  ///< the surface gives way
};

/// The reason why an effect is on or off for one material, as `inspect` prints it.
struct PlannedEffect {
    Effect effect;
    int material; ///< Scene material
    bool on;
    std::string reason; ///< "normal map of the PBR material, influence 1"
    /// Memory besides the geometry: maps and vertex attributes. Texture coordinates that several maps read
    /// count with the first of them.
    uint64_t memoryBytes;
};

/// The effects that the scene uses. Effects that no material uses cost nothing in the tick
/// (docs/architecture.md, The effect plan).
struct EffectPlan {
    std::vector<PlannedEffect> effects;
    bool plainSample = false; ///< every touchable material is plain: the tick has no stages 5 and 6
    bool dampingMap = false;  ///< some touchable material has one; it also scales the session's damping
    bool programs = false;    ///< some touchable material has a haptic program
    bool deformation = false; ///< some touchable material gives way
    bool oneSided = false;    ///< some touchable object is felt only from its front
    /// Some smooth surface has a material whose shading is not off; is two-pass by default; is projected or
    /// direction. With none of them the tick has no stage 4.
    bool anyShading = false, twoPassShading = false, oneFacetShading = false;
};

[[nodiscard]] const char* effectName(Effect effect);

} // namespace touchstone

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
    VaryingStiffness ///< by map or vertex
};

/// Why an effect is on or off for one material, as `inspect` prints it.
struct PlannedEffect {
    Effect effect;
    int material; ///< Scene material
    bool on;
    std::string reason; ///< "normal map of the PBR material, influence 1"
    /// What it holds besides the geometry: maps, and what it reads at the vertices. Texture coordinates that
    /// several maps read count with the first of them.
    uint64_t memoryBytes;
};

/// What the scene calls for. What no material needs costs nothing in the tick (docs/architecture.md, The
/// effect plan).
struct EffectPlan {
    std::vector<PlannedEffect> effects;
    // Smooth surfaces: of any material that does not say off; of those that are two-pass by themselves; of
    // those that say projected or direction. Where none is, stage 4 is not there.
    bool plainSample = false; ///< every touchable material is plain: stages 5 and 6 are not there either
    bool dampingMap =
        false; ///< some touchable material has one, which a session's own damping is multiplied by
    bool oneSided = false; ///< some touchable object shows only its front
    bool anyShading = false, twoPassShading = false, oneFacetShading = false;
};

[[nodiscard]] const char* effectName(Effect effect);

} // namespace touchstone

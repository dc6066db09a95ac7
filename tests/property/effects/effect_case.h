#pragma once
// Which effects meet in a trial: one level of each factor, all pairs of levels in few cases or the full
// product.

#include "haptics/settings/haptic_settings.h"

#include <array>
#include <string>
#include <vector>

namespace touchstone::test {

/// The bodies that are stroked. Suzanne and ToyCar come from TOUCHSTONE_MODELS.
enum class EffectBody : uint8_t { Sphere, FineSphere, Torus, Box, Room, Suzanne, ToyCar };
/// Shallow: 1 mm at 0.1 m/s. Deep: to 95 % of the body's radius, then circles there. Fast: 4 mm at 2 m/s.
enum class EffectStroke : uint8_t { Shallow, Deep, Fast };

struct EffectCase {
    EffectBody body = EffectBody::Sphere;
    EffectStroke stroke = EffectStroke::Shallow;
    ShadingMode shading = ShadingMode::Off;
    FrictionMode friction = FrictionMode::Off;
    TextureMode texture = TextureMode::Off;
    double radius = 0.0; ///< workspace m
    bool oneSided = false;
    bool moving = false; ///< the objects move, against each other too

    [[nodiscard]] std::string name() const;
    /// The coefficients of friction alternate from case to case: 0.45 and 0.36, 1.2 and 0.8.
    [[nodiscard]] HapticSettings settings(unsigned seed) const;
};

/// As test names have it, with `identifier` without what gtest does not take.
[[nodiscard]] std::string bodyName(EffectBody body, bool identifier = false);
[[nodiscard]] std::string strokeName(EffectBody body, EffectStroke stroke);

/// Every combination of effects on this body under this stroke.
[[nodiscard]] std::vector<EffectCase> effectProduct(EffectBody body, EffectStroke stroke);
/// Few of them, in which any two levels of any two factors meet at least once: a greedy covering array. The
/// seed chooses among such arrays.
[[nodiscard]] std::vector<EffectCase> effectPairs(EffectBody body, EffectStroke stroke, unsigned seed);

} // namespace touchstone::test

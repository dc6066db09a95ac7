#pragma once
// A Phantom Premium 1.5 in a light grip that holds still on tilted normals: tilt_limit and its test.

#include "haptics/scene/haptic_scene.h"
#include "haptics/settings/haptic_settings.h"
#include "study/timing/bench_scene.h"

#include <glm/glm.hpp>

namespace touchstone::test {

inline constexpr int kTiltedPlaces = 24;
inline constexpr double kTiltedSwing = 1e-4; ///< m, three steps of the sensor

/// Where the hand rests on the surface, and the normal there.
struct TiltedPlace {
    glm::dvec3 point{0.0}, normal{0.0};
};

/// A plane with a bump map of waves: 1 mm long, 45 degrees steep. Places are on one wave.
[[nodiscard]] BenchScene tiltedWaves();
[[nodiscard]] TiltedPlace onWaves(int place);

/// A prism of four sides that is shaded round. Places are on half a face, from its middle to its edge, along
/// the radius.
[[nodiscard]] BenchScene tiltedPrism();
[[nodiscard]] TiltedPlace onPrism(int place);

/// What the last second of four comes to.
struct TiltedHold {
    double swing = 0.0; ///< of the device, m
    double power = 0.0; ///< of the motors less what the device's friction takes, mean, W; 0 where it is taken
};

/// A hand comes down from a centimetre above and wants to press with `push` N. 1 kHz.
[[nodiscard]] TiltedHold holdStill(const HapticScene& scene, const HapticSettings& settings,
                                   const TiltedPlace& place, double push);

} // namespace touchstone::test

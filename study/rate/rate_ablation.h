#pragma once
// Benefit and cost of a faster servo: the stiffest stable wall, the energy that a stroke gains, processor
// load.

#include "devices/plant/plant_parameters.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/settings/haptic_settings.h"
#include "study/result/result.h"

#include <functional>
#include <span>
#include <vector>

namespace touchstone::study {

inline constexpr double kServoRates[]{500.0, 1000.0, 2000.0, 4000.0};

/// A plane of 0.2 m through the origin, normal y, and a wall of it that is a spring and nothing else.
[[nodiscard]] const HapticScene& pressedPlane();
[[nodiscard]] HapticSettings frictionlessWall(double stiffness);

/// The device that presses walls: as heavy as a Phantom Premium 1.5, 1 N·s/m of viscous friction, no hand, no
/// Coulomb friction, an exact sensor, motors that do not saturate. Its bound 2 b / T is the passivity
/// condition for every passive hand, and within 1 to 4 % the exact limit of the device alone
/// (docs/closed_loop.md).
[[nodiscard]] PlantParameters pressingDevice();
[[nodiscard]] double stiffnessBound(const PlantParameters& device, double rateHz);

/// True if a device that a constant weight presses 1 mm into a plane returns to rest there: after a
/// disturbance of a tenth of that, its oscillation is larger in the second quarter of `ticks` than in the
/// last.
[[nodiscard]] bool pressedWallSettles(const PlantParameters& device, const HapticSettings& wall,
                                      double rateHz, int ticks);

/// The stiffest wall with `pressedWallSettles`, N/m, within a relative 1e-4; 0 where even a 64th of the bound
/// is unstable.
[[nodiscard]] double stiffestStable(const PlantParameters& device, double rateHz);

struct RateOptions {
    int rounds = 20;      ///< strokes at each rate, the rates interleaved
    double seconds = 1.0; ///< of each stroke, from the start of the descent
};

/// At each of `rates`: the stiffest wall; and for a Phantom Premium 1.5 in a light grip that strokes the
/// torus of 64,800 triangles with the default settings, the maximum energy that it gains beyond its friction
/// losses and the fraction of a processor that the steps take. Stretches in which another program had the
/// processor are left out. Calling thread; `progress` gets 0..1.
[[nodiscard]] std::vector<RateResult> studyRates(std::span<const double> rates, const RateOptions& options,
                                                 const std::function<void(double)>& progress);

} // namespace touchstone::study

#pragma once
// What a faster servo buys and costs: the stiffest stable wall, energy that a stroke is given, processor.

#include "devices/plant/plant_parameters.h"
#include "haptics/settings/haptic_settings.h"
#include "study/result/result.h"

#include <functional>
#include <span>
#include <vector>

namespace touchstone::study {

inline constexpr double kServoRates[]{500.0, 1000.0, 2000.0, 4000.0};

/// The device that walls are pressed with: as heavy as a Phantom Premium 1.5, 1 N·s/m of viscous friction, no
/// hand, no Coulomb friction, an exact sensor, motors that do not saturate. 2 b / T is its bound: what it
/// takes for every passive hand, and by 1 to 4 % the exact limit of the device alone (docs/closed_loop.md).
[[nodiscard]] PlantParameters pressingDevice();
[[nodiscard]] double stiffnessBound(const PlantParameters& device, double rateHz);

/// True if a device that a constant weight presses 1 mm into a plane comes back to its rest there: disturbed
/// by a tenth of that, its swings in the second quarter of `ticks` are larger than in the last.
[[nodiscard]] bool pressedWallSettles(const PlantParameters& device, const HapticSettings& wall,
                                      double rateHz, int ticks);

/// The stiffest wall that `pressedWallSettles`, N/m, to 1e-4 of itself; 0 where even a 64th of the bound does
/// not.
[[nodiscard]] double stiffestStable(const PlantParameters& device, double rateHz);

struct RateOptions {
    int rounds = 20;      ///< strokes at each rate, the rates in turn
    double seconds = 1.0; ///< of each stroke, from where the hand comes down
};

/// At each of `rates`: the stiffest wall; and a Phantom Premium 1.5 in a light grip that strokes the torus of
/// 64,800 triangles with the program's own settings: most energy that it was given beyond what its friction
/// took, and the share of a processor that the steps take; stretches in which another program had the
/// processor are left out. Calling thread; `progress` gets 0..1.
[[nodiscard]] std::vector<RateResult> studyRates(std::span<const double> rates, const RateOptions& options,
                                                 const std::function<void(double)>& progress);

} // namespace touchstone::study

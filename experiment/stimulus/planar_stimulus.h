#pragma once
// The curve of a condition at a level, and how it differs from another one under a stroke of the finger.

#include "experiment/plan/study_plan.h"
#include "haptics/finger/planar_touch.h"

namespace touchstone::experiment {

/// `level`: the number of segments, where the stimulus has none of its own. Throws Error.
[[nodiscard]] PlanarSurface surfaceOf(const PlanarStimulus& stimulus, double level);

/// One stroke over the middle of a reference, at a constant depth below it.
struct Stroke {
    double speed = 0.086;   ///< m/s along the surface
    double force = 0.49;    ///< N, normal, on the reference
    double share = 0.9;     ///< of the arc, about its top: the ends have edges of their own
    double rateHz = 1000.0; ///< of the servo
};

/// Variances over the stroke of comparison - reference: a constant difference is taken up by the hand, which
/// sets its mean force itself and does not know where the surface is to a hundredth of a millimetre.
struct StrokeDifference {
    double tangential = 0.0; ///< N^2, along the reference's tangent
    double normal = 0.0;     ///< N^2
    double location = 0.0;   ///< m^2, of the contact location
    size_t ticks = 0;
};

/// Renders both stimuli tick by tick as the servo does, with the finger on one path (pitch 0). The reference
/// is a smooth arc. Throws Error for another one.
[[nodiscard]] StrokeDifference compare(const PlanarStimulus& reference, const PlanarStimulus& comparison,
                                       double level, const Stroke& stroke = {});

} // namespace touchstone::experiment

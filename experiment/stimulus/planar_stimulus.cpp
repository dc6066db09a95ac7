#include "experiment/stimulus/planar_stimulus.h"

#include "engine/core/error.h"

#include <algorithm>
#include <cmath>

namespace touchstone::experiment {

PlanarSurface surfaceOf(const PlanarStimulus& stimulus, double level) {
    switch (stimulus.curve) {
    case PlanarStimulus::Curve::Arc:
        return PlanarSurface(stimulus.arc);
    case PlanarStimulus::Curve::Polygon:
        return PlanarSurface(polygonOf(stimulus.arc, stimulus.segments > 0
                                                         ? stimulus.segments
                                                         : static_cast<size_t>(std::lround(level))));
    case PlanarStimulus::Curve::Points:
        break;
    }
    return PlanarSurface(Polyline(stimulus.points, stimulus.closed));
}

StrokeDifference compare(const PlanarStimulus& reference, const PlanarStimulus& comparison, double level,
                         const Stroke& stroke) {
    if (reference.curve != PlanarStimulus::Curve::Arc)
        throw Error("observer", "", "its reference is no smooth arc",
                    "a curve that is drawn by points is for people");
    const PlanarSurface smooth = surfaceOf(reference, level), other = surfaceOf(comparison, level);
    const ArcFinger finger;
    PlanarTouch first(smooth, reference.rendering, finger), second(other, comparison.rendering, finger);
    const SmoothArc& arc = reference.arc;
    const double depth = stroke.force / reference.rendering.stiffness;
    const double half = 0.5 * stroke.share * arc.angle, step = stroke.speed / (stroke.rateHz * arc.radius);
    StrokeDifference sum;
    glm::dvec3 mean(0.0), squares(0.0); // tangential, normal, location
    for (double at = -half; at <= half; at += step) {
        const glm::dvec2 normal(std::sin(at), std::cos(at)), tangent(normal.y, -normal.x);
        // The finger's circle is `depth` into the arc at `at`; its pad's middle is below the circle's centre.
        const glm::dvec2 centre = arc.centre() + (arc.radius + finger.radius - depth) * normal;
        const FingerPose pose{.pad = centre - glm::dvec2(0.0, finger.radius)};
        const PlanarTouch::Felt a = first.step(pose), b = second.step(pose);
        const glm::dvec2 force = b.force - a.force;
        const glm::dvec3 difference(glm::dot(force, tangent), glm::dot(force, normal),
                                    b.location - a.location);
        mean += difference;
        squares += difference * difference;
        ++sum.ticks;
    }
    const auto ticks = static_cast<double>(std::max<size_t>(sum.ticks, 1));
    const glm::dvec3 variance = glm::max(squares / ticks - (mean / ticks) * (mean / ticks), glm::dvec3(0.0));
    sum.tangential = variance.x;
    sum.normal = variance.y;
    sum.location = variance.z;
    return sum;
}

} // namespace touchstone::experiment

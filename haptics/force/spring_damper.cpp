#include "haptics/force/spring_damper.h"

#include "haptics/surface/program_surface.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

glm::dvec3 springDamperForce(const SurfaceSample& feel, const glm::dvec3& frictionStretch,
                             const glm::dvec3& viscousForce, const glm::dvec3& velocity) noexcept {
    if (!feel.touching)
        return glm::dvec3(0.0);
    const double d = feel.depth, height = feel.height;
    const glm::dvec3& n = feel.normal;
    const glm::dvec3& m = feel.textured;
    const double raised = feel.bump == 0.0 ? d : std::max(d + feel.bump, 0.0);
    glm::dvec3 elastic =
        withProgram(feel,
                    feel.stiffness * (feel.hasHeight && d >= height ? (d - height) * n + height * m
                                                                    : feel.lengthening * raised * m),
                    1.0);
    if (feel.dent > 0.0) [[unlikely]]
        elastic += feel.stiffness * d * feel.dentSlope;
    const double into = glm::dot(velocity, n);
    const double wall = glm::dot(elastic, n);
    const double damping = std::max(-feel.damping * into, -std::max(wall, 0.0)); // a wall does not pull
    return elastic + feel.stiffness * frictionStretch + damping * n + viscousForce;
}

double bearableShare(double stiffness, double zoom, const HapticSettings& settings,
                     const DeviceLimits& limits) noexcept {
    const double most = std::max(settings.stiffness, limits.maxStiffness), felt = stiffness * zoom;
    return felt > most ? most / felt : 1.0;
}

double yieldingShare(const glm::dvec3& force, double press) noexcept {
    const double length = glm::length(force);
    return length > press && std::isfinite(length) ? press / length : 1.0;
}

} // namespace touchstone

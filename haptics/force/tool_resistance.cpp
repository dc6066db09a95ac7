#include "haptics/force/tool_resistance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace touchstone {

namespace {

constexpr size_t kPoints = 96;

/// Fibonacci's spiral: points of equal area, whose order is that of their z.
std::array<glm::dvec3, kPoints> spiral() {
    std::array<glm::dvec3, kPoints> points;
    const double turn = std::numbers::pi * (3.0 - std::sqrt(5.0));
    for (size_t i = 0; i < kPoints; ++i) {
        const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(kPoints);
        const double r = std::sqrt(1.0 - z * z), angle = turn * static_cast<double>(i);
        points[i] = {r * std::cos(angle), r * std::sin(angle), z};
    }
    return points;
}

const std::array<glm::dvec3, kPoints> kSphere = spiral(); // made before the servo starts

} // namespace

double sweptVolume(const PotentialField& field, const Similarity& workspaceFromObject,
                   const glm::dvec3& centre, double radius, const glm::dvec3& velocity) noexcept {
    double sum = 0.0;
    for (const glm::dvec3& normal : kSphere) {
        const double speed = glm::dot(velocity, normal);
        if (speed > 0.0 && field.value(workspaceFromObject.inversePoint(centre + radius * normal)) < 0.0)
            sum += speed;
    }
    return sum * 4.0 * std::numbers::pi * radius * radius / static_cast<double>(kPoints);
}

glm::dvec3 toolResistance(const PotentialField& field, const Similarity& workspaceFromObject,
                          const LiveTool& tool, const glm::dvec3& centre, const glm::dvec3& velocity,
                          double mass, double dt) noexcept {
    const double speed = glm::length(velocity);
    if (!(speed > 0.0) || (tool.tool != SculptTool::Carve && tool.tool != SculptTool::Imprint))
        return glm::dvec3(0.0);
    const double volume =
        tool.strength * sweptVolume(field, workspaceFromObject, centre, tool.radius, velocity);
    const double drag = std::min(tool.resistance * volume / speed, 0.25 * mass / dt); // N s/m
    return -drag * velocity;
}

} // namespace touchstone

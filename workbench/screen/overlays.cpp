#include "workbench/screen/overlays.h"

#include "workbench/readings/force_parts.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

// Sizes in the workspace, m: a model is fitted to 150 mm.
constexpr double kHipRadius = 1.6e-3;
constexpr double kMinProxyRadius = 2.6e-3; // a god-object has radius zero and must be visible
constexpr double kStictionRadius = 1.1e-3;
constexpr double kPlaneRadius = 9e-3;
constexpr double kForceLength = 0.04; // m of arrow per newton
constexpr double kMaxForceLength = 0.1;
constexpr double kArrowRadius = 0.8e-3;
constexpr double kNormalLength = 0.018;
constexpr double kNormalRadius = 0.45e-3;
constexpr double kConeLength = 0.016;
constexpr int kConeSides = 24;

constexpr glm::vec4 kHipColor{0.95f, 0.16f, 0.08f, 1.0f};
constexpr glm::vec4 kProxyColor{0.10f, 0.45f, 1.0f, 1.0f};
constexpr glm::vec4 kForceColor{1.0f, 0.72f, 0.05f, 1.0f};
constexpr glm::vec4 kUnsentColor{0.55f, 0.57f, 0.6f, 1.0f}; // a force that is not sent to the device
constexpr glm::vec4 kPlaneColor{0.35f, 0.8f, 1.0f, 0.25f};
constexpr glm::vec4 kStictionColor{0.1f, 0.9f, 0.35f, 1.0f};
constexpr glm::vec4 kConeColor{0.1f, 0.9f, 0.35f, 0.55f};
constexpr glm::vec4 kNormalColor{0.9f, 0.9f, 0.95f, 1.0f};

double drawnRadius(const HapticSettings& settings, double scale) {
    return std::max(settings.proxyRadius, scale * kMinProxyRadius);
}

/// Rim and some generators of a cone with apex `tip` along unit `axis`; `slope` is the tangent of its half
/// angle.
void drawCone(const glm::dvec3& tip, const glm::dvec3& axis, double slope, double length, Overlay& overlay) {
    const glm::dvec3 other = std::abs(axis.x) < 0.7 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 0.0, 1.0);
    const glm::dvec3 u = glm::normalize(glm::cross(other, axis)), v = glm::cross(axis, u);
    // Cones have the same slant length.
    const double along = length / std::sqrt(1.0 + slope * slope);
    const auto rim = [&](int side) {
        const double angle = glm::two_pi<double>() * side / kConeSides;
        return tip + along * (axis + slope * (std::cos(angle) * u + std::sin(angle) * v));
    };
    for (int side = 0; side < kConeSides; ++side) {
        overlay.lines.push_back({.from = rim(side), .to = rim(side + 1), .color = kConeColor});
        if (side % 4 == 0)
            overlay.lines.push_back({.from = tip, .to = rim(side), .color = kConeColor, .width = 1.0f});
    }
}

} // namespace

void drawTick(const TickRecord& record, const HapticSettings& settings, const TickLook& look,
              Overlay& overlay) {
    const HapticOutput& tick = record.output;
    const double scale = look.scale;
    if (look.shown.probe) {
        overlay.spheres.push_back({tick.hip, scale * kHipRadius, kHipColor});
        overlay.spheres.push_back({tick.proxy, drawnRadius(settings, scale), kProxyColor});
    }
    if (tick.contacts == 0)
        return;
    if (look.shown.probe)
        overlay.lines.push_back({.from = tick.hip, .to = tick.proxy, .color = kHipColor});
    const double force = glm::length(tick.force);
    if (look.shown.force && force > 0.0) {
        const double length = scale * std::min(kForceLength * force, kMaxForceLength);
        overlay.arrows.push_back({tick.proxy, tick.proxy + tick.force * (length / force),
                                  scale * kArrowRadius,
                                  forceSent(tick, settings) ? kForceColor : kUnsentColor});
    }
    if (look.shown.planes)
        for (uint32_t i = 0; i < tick.planeCount; ++i)
            overlay.discs.push_back({tick.proxy - settings.proxyRadius * tick.planes[i], tick.planes[i],
                                     scale * kPlaneRadius, kPlaneColor});
    if (look.shown.normal)
        overlay.arrows.push_back({tick.proxy, tick.proxy + scale * kNormalLength * tick.normal,
                                  scale * kNormalRadius, kNormalColor});
    if (!look.shown.friction || tick.friction == FrictionState::Free)
        return;
    overlay.spheres.push_back({tick.stictionPoint, scale * kStictionRadius, kStictionColor});
    // Each plane that holds the hand has a cone; the friction force is their sum.
    if (look.frictionCoefficient > 0.0 && tick.planeCount <= 1 && glm::length(tick.normal) > 0.5)
        drawCone(tick.stictionPoint, tick.normal, look.frictionCoefficient, scale * kConeLength, overlay);
}

ProbeShadow probeShadow(const TickRecord& record, const HapticSettings& settings) {
    return {record.output.proxy, drawnRadius(settings, 1.0)};
}

double frictionCoefficientAt(const TickRecord& record, const HapticSettings& settings, const Scene& scene,
                             const HapticScene& haptic) {
    const int object = record.output.object;
    if (settings.friction == FrictionMode::Off || object < 0 ||
        object >= static_cast<int>(haptic.objects.size()))
        return 0.0;
    if (settings.staticFriction >= 0.0)
        return settings.staticFriction;
    const auto material = static_cast<size_t>(haptic.objects[static_cast<size_t>(object)]->material);
    if (material >= scene.materials.size())
        return 0.0;
    return static_cast<double>(scene.materials[material].haptic.staticFriction.value.value_or(0.0f));
}

} // namespace touchstone

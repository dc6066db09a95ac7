#include "workbench/window/overlays.h"

#include <algorithm>

namespace touchstone {

namespace {

// Sizes in the workspace, m: a model is fitted to 150 mm.
constexpr double kHipRadius = 1.6e-3;
constexpr double kLeastProxyRadius = 2.6e-3; // a god-object has none, but must be seen
constexpr double kStictionRadius = 1.1e-3;
constexpr double kPlaneRadius = 9e-3;
constexpr double kForceLength = 0.04; // m of arrow for one newton
constexpr double kMostForceLength = 0.1;
constexpr double kArrowRadius = 0.8e-3;

constexpr glm::vec4 kHipColor{0.95f, 0.16f, 0.08f, 1.0f};
constexpr glm::vec4 kProxyColor{0.10f, 0.45f, 1.0f, 1.0f};
constexpr glm::vec4 kForceColor{1.0f, 0.72f, 0.05f, 1.0f};
constexpr glm::vec4 kPlaneColor{0.35f, 0.8f, 1.0f, 0.25f};
constexpr glm::vec4 kStictionColor{0.1f, 0.9f, 0.35f, 1.0f};

} // namespace

void drawTick(const TickRecord& record, const HapticSettings& settings, Overlay& overlay) {
    const HapticOutput& tick = record.output;
    overlay.spheres.push_back({tick.hip, kHipRadius, kHipColor});
    overlay.spheres.push_back({tick.proxy, std::max(settings.proxyRadius, kLeastProxyRadius), kProxyColor});
    if (tick.contacts == 0)
        return;
    overlay.lines.push_back({.from = tick.hip, .to = tick.proxy, .color = kHipColor});
    const double force = glm::length(tick.force);
    if (force > 0.0) {
        const double length = std::min(kForceLength * force, kMostForceLength);
        overlay.arrows.push_back(
            {tick.proxy, tick.proxy + tick.force * (length / force), kArrowRadius, kForceColor});
    }
    for (uint32_t i = 0; i < tick.planeCount; ++i)
        overlay.discs.push_back(
            {tick.proxy - settings.proxyRadius * tick.planes[i], tick.planes[i], kPlaneRadius, kPlaneColor});
    if (tick.friction != FrictionState::Free)
        overlay.spheres.push_back({tick.stictionPoint, kStictionRadius, kStictionColor});
}

ProbeShadow probeShadow(const TickRecord& record, const HapticSettings& settings) {
    return {record.output.proxy, std::max(settings.proxyRadius, kLeastProxyRadius)};
}

} // namespace touchstone

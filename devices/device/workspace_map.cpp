#include "devices/device/workspace_map.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// One step of the zoom towards the target zoom.
double zoomed(double zoom, double wanted, double dt) {
    if (!(wanted > 0.0))
        return zoom; // not a number
    const double goal = std::clamp(wanted, kMinZoom, kMaxZoom);
    const double step = std::exp(WorkspaceMap::kZoomRate * dt);
    return std::clamp(goal, zoom / step, zoom * step);
}

} // namespace

void WorkspaceMap::begin(const WorkspaceWish& target, const glm::dvec3& place) noexcept {
    mapping_.workspaceFromDevice = {};
    if (target.zoom > 0.0)
        mapping_.workspaceFromDevice.scale = std::clamp(target.zoom, kMinZoom, kMaxZoom);
    mapping_.workspaceFromDevice.translation = (1.0 - mapping_.workspaceFromDevice.scale) * place;
    placed_ = false;
    centring_ = 0.0;
}

void WorkspaceMap::apply(DeviceSample& sample, const WorkspaceWish& target, double seconds) noexcept {
    const double dt = seconds > 0.0 ? std::min(seconds, kLongestStep) : 0.0; // also maps NaN to 0
    Similarity& map = mapping_.workspaceFromDevice;
    const double fade = target.clutch ? -dt / kClutchOut : dt / kClutchIn;
    mapping_.coupling = std::clamp(mapping_.coupling + fade, 0.0, 1.0);
    if (centring_ > 0.0) {
        centring_ -= dt;
        sample.valid = false;
        if (centring_ <= 0.0)
            begin(target, centre_);
    } else if (sample.valid) {
        const double zoom = zoomed(map.scale, target.zoom, dt);
        const glm::dvec3 hip = target.clutch && placed_ ? hip_ : map.point(sample.position);
        if (target.clutch || zoom != map.scale) {
            map.scale = zoom;
            map.translation = hip - zoom * sample.position;
        }
        hip_ = hip;
        placed_ = true;
    }
    sample.mapping = mapping_;
}

} // namespace touchstone

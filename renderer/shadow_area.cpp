#include "renderer/shadow_area.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// Of a box around the ball, in units of clip space; everything where it reaches behind the eye.
struct ClipRect {
    glm::dvec2 low{1e300}, high{-1e300};

    void include(const glm::dmat4& clipFromWorkspace, const glm::dvec3& centre, double radius) {
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 offset((corner & 1) != 0 ? radius : -radius,
                                    (corner & 2) != 0 ? radius : -radius,
                                    (corner & 4) != 0 ? radius : -radius);
            const glm::dvec4 clip = clipFromWorkspace * glm::dvec4(centre + offset, 1.0);
            if (!(clip.z > 0.0) || !(clip.w > 0.0)) {
                low = glm::dvec2(-1.0);
                high = glm::dvec2(1.0);
                return;
            }
            const glm::dvec2 at = glm::dvec2(clip) / clip.w;
            low = glm::min(low, at);
            high = glm::max(high, at);
        }
    }
};

} // namespace

PixelArea shadowArea(const View& view, const glm::ivec2& size) {
    if (!(view.probe.radius > 0.0))
        return {};
    const glm::dmat4 clipFromWorkspace = view.clipFromView * view.viewFromWorkspace;
    const glm::dvec3 centre = view.probe.centre;
    ClipRect rect;
    // Of the surroundings at most 1 / distance² is hidden, in radii.
    rect.include(clipFromWorkspace, centre, view.probe.radius / std::sqrt(kUnseen));
    // Of the light 0.9 * 1.5 / width² within width = 1.25 + 0.13 * along, in radii; the hull of the cone's
    // ends is that of its first and last ball.
    const double width = std::sqrt(0.9 * 1.5 / kUnseen), along = (width - 1.25) / 0.13;
    const double length = glm::length(view.lights[0].toLight);
    if (length > 0.0 && view.lights[0].irradiance != glm::vec3(0.0f))
        rect.include(clipFromWorkspace,
                     centre - view.lights[0].toLight * (along * view.probe.radius / length),
                     width * view.probe.radius);
    const glm::dvec2 extent(size);
    // y up in clip space, down in the picture; a pixel is drawn where its centre is inside.
    const glm::dvec2 low = glm::dvec2(0.5 + 0.5 * rect.low.x, 0.5 - 0.5 * rect.high.y) * extent;
    const glm::dvec2 high = glm::dvec2(0.5 + 0.5 * rect.high.x, 0.5 - 0.5 * rect.low.y) * extent;
    const auto pixel = [](double at, int most) {
        return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(most)));
    };
    return {.low = {pixel(std::floor(low.x), size.x), pixel(std::floor(low.y), size.y)},
            .high = {pixel(std::ceil(high.x), size.x), pixel(std::ceil(high.y), size.y)}};
}

} // namespace touchstone

#include "renderer/camera.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

constexpr double kFrameMargin = 1.05; ///< margin around a framed box

/// Direction from the target to the eye. Yaw turns +z towards +x, pitch lifts towards +y.
glm::dvec3 back(const OrbitCamera& camera) {
    const double cosPitch = std::cos(camera.pitch);
    return {cosPitch * std::sin(camera.yaw), std::sin(camera.pitch), cosPitch * std::cos(camera.yaw)};
}

/// Metres that one pixel spans at a depth of one metre.
double metresPerPixelAtUnitDepth(double fovY, double heightPixels) {
    return 2.0 * std::tan(0.5 * fovY) / std::max(heightPixels, 1.0);
}

} // namespace

OrbitCamera OrbitCamera::threeQuarter(const Bounds& bounds, double aspect) {
    OrbitCamera camera;
    camera.orbit(0.45, 0.35);
    camera.frame(bounds, aspect);
    return camera;
}

glm::dvec3 OrbitCamera::eye() const {
    return target + distance * back(*this);
}
glm::dvec3 OrbitCamera::forward() const {
    return -back(*this);
}
glm::dvec3 OrbitCamera::right() const {
    return {std::cos(yaw), 0.0, -std::sin(yaw)};
}
glm::dvec3 OrbitCamera::up() const {
    return glm::cross(right(), forward());
}

double OrbitCamera::nearPlane() const {
    if (orthographic) // all that lies before the target, however near that is
        return distance - 4.0 * sceneRadius;
    // Float depth holds about 1e-7 of the range near 1, so the ratio far/near is kept below some 1e4.
    return std::max(distance - 2.0 * sceneRadius, 0.05 * distance);
}

double OrbitCamera::farPlane() const {
    return distance + 4.0 * sceneRadius;
}

glm::dmat4 OrbitCamera::viewFromWorkspace() const {
    const glm::dvec3 x = right(), y = up(), z = back(*this), e = eye();
    return {glm::dvec4(x.x, y.x, z.x, 0.0), glm::dvec4(x.y, y.y, z.y, 0.0), glm::dvec4(x.z, y.z, z.z, 0.0),
            glm::dvec4(-glm::dot(x, e), -glm::dot(y, e), -glm::dot(z, e), 1.0)};
}

glm::dmat4 OrbitCamera::clipFromView(double aspect) const {
    if (!orthographic)
        return glm::perspectiveRH_ZO(fovY, aspect, nearPlane(), farPlane());
    const double half = distance * std::tan(0.5 * fovY);
    return glm::orthoRH_ZO(-half * aspect, half * aspect, -half, half, nearPlane(), farPlane());
}

void OrbitCamera::lookFrom(Side side) {
    constexpr double kQuarter = glm::half_pi<double>();
    constexpr std::array<glm::dvec2, kSideNames.size()> kYawPitch{{{0.0, 0.0},
                                                                   {2.0 * kQuarter, 0.0},
                                                                   {kQuarter, 0.0},
                                                                   {-kQuarter, 0.0},
                                                                   {0.0, kQuarter},
                                                                   {0.0, -kQuarter}}};
    yaw = kYawPitch[static_cast<size_t>(side)].x;
    pitch = kYawPitch[static_cast<size_t>(side)].y;
}

void OrbitCamera::orbit(double deltaYaw, double deltaPitch) {
    yaw = std::remainder(yaw + deltaYaw, glm::two_pi<double>());
    pitch = std::clamp(pitch + deltaPitch, -kMaxPitch, kMaxPitch);
}

void OrbitCamera::pan(const glm::dvec2& pixels, double heightPixels) {
    target -= viewPlaneDisplacement(pixels, heightPixels, target);
}

void OrbitCamera::zoom(double factor) {
    distance = std::clamp(distance * factor, 1e-2 * sceneRadius, 1e3 * sceneRadius);
}

void OrbitCamera::frame(const Bounds& bounds, double aspect) {
    target = bounds.empty() ? glm::dvec3(0.0) : bounds.centre();
    sceneRadius = 0.5 * bounds.diagonal();
    if (!(sceneRadius > 0.0))
        sceneRadius = 0.05;
    // A corner with (x, y) across and z towards the eye from the centre is inside at distance d when
    // |x| <= (d - z) tan(halfX) and |y| <= (d - z) tan(halfY).
    const double slopeY = std::tan(0.5 * fovY), slopeX = slopeY * aspect;
    const glm::dvec3 half = 0.5 * bounds.extent();
    distance = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p = half * glm::dvec3((corner & 1) ? 1.0 : -1.0, (corner & 2) ? 1.0 : -1.0,
                                               (corner & 4) ? 1.0 : -1.0);
        const double across =
            std::max(std::abs(glm::dot(p, right())) / slopeX, std::abs(glm::dot(p, up())) / slopeY);
        distance = std::max(distance, across + (orthographic ? 0.0 : glm::dot(p, back(*this))));
    }
    distance = std::max(kFrameMargin * distance, orthographic ? 0.01 * sceneRadius : sceneRadius);
}

Ray OrbitCamera::rayThroughPixel(const glm::dvec2& pixel, const glm::dvec2& imageSize) const {
    const double slope = metresPerPixelAtUnitDepth(fovY, imageSize.y);
    const glm::dvec2 fromCentre = (pixel - 0.5 * imageSize) * slope;
    if (orthographic)
        return {eye() + nearPlane() * forward() + distance * (fromCentre.x * right() - fromCentre.y * up()),
                forward()};
    return {eye(), glm::normalize(forward() + fromCentre.x * right() - fromCentre.y * up())};
}

glm::dvec3 OrbitCamera::viewPlaneDisplacement(const glm::dvec2& pixels, double heightPixels,
                                              const glm::dvec3& at) const {
    const double depth = orthographic ? distance : std::max(glm::dot(at - eye(), forward()), nearPlane());
    const double metres = depth * metresPerPixelAtUnitDepth(fovY, heightPixels);
    return metres * (pixels.x * right() - pixels.y * up());
}

glm::dvec3 OrbitCamera::pixelOf(const glm::dvec3& point, const glm::dvec2& imageSize) const {
    const glm::dvec3 fromEye = point - eye();
    const double depth = glm::dot(fromEye, forward());
    const double spread = orthographic ? distance : std::max(std::abs(depth), 1e-300);
    const double scale = 1.0 / (spread * metresPerPixelAtUnitDepth(fovY, imageSize.y));
    return {0.5 * imageSize.x + glm::dot(fromEye, right()) * scale,
            0.5 * imageSize.y - glm::dot(fromEye, up()) * scale, depth};
}

} // namespace touchstone

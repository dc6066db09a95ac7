#include "renderer/scene_camera.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace touchstone {

namespace {

/// Below this sine of the angle between the direction of sight and `up` the picture's horizon is rounding.
constexpr double kLeastSine = 1e-6;
constexpr double kLeastNear = 1e-3; ///< of the far plane's distance, in a perspective
constexpr double kRoom = 1e-3;      ///< between the bounds and the planes, of the bounds' diagonal

std::array<glm::dvec3, 8> cornersOf(const Bounds& bounds) {
    std::array<glm::dvec3, 8> corners;
    for (size_t i = 0; i < corners.size(); ++i)
        corners[i] = {(i & 1) != 0 ? bounds.high.x : bounds.low.x,
                      (i & 2) != 0 ? bounds.high.y : bounds.low.y,
                      (i & 4) != 0 ? bounds.high.z : bounds.low.z};
    return corners;
}

struct Depths {
    double low = 0.0, high = 0.0; ///< m before the eye
};

/// Where the near and the far plane stand.
Depths planesOf(const SceneCamera& camera, const Bounds& bounds) {
    Depths of{INFINITY, -INFINITY};
    if (!bounds.empty())
        for (const glm::dvec3& corner : cornersOf(bounds)) {
            const double depth = glm::dot(camera.eye - corner, camera.axes[2]);
            of = {std::min(of.low, depth), std::max(of.high, depth)};
        }
    const double diagonal = bounds.diagonal(), room = diagonal > 0.0 ? kRoom * diagonal : 1.0;
    Depths planes{std::max(camera.nearPlane, of.low - room), std::min(camera.farPlane, of.high + room)};
    if (!camera.orthographic)
        planes.low = std::max(planes.low, kLeastNear * planes.high);
    if (planes.high > planes.low && std::isfinite(planes.low) && std::isfinite(planes.high))
        return planes;
    planes.low = camera.orthographic ? camera.nearPlane : std::max(camera.nearPlane, room); // nothing is seen
    return {planes.low, planes.low + room};
}

/// Tangent of half the vertical angle of a perspective, half the height of an orthographic picture.
double halfFrame(const SceneCamera& camera, double aspect) {
    const double own = camera.orthographic ? camera.halfHeight : std::tan(0.5 * camera.fovY);
    return camera.aspect > aspect ? own * camera.aspect / aspect : own;
}

/// `m` scales lengths of the camera and of the planes.
glm::dmat4 projection(const SceneCamera& camera, const Depths& planes, double aspect, double m) {
    const double half = halfFrame(camera, aspect);
    return camera.orthographic
               ? glm::orthoRH_ZO(-half * aspect * m, half * aspect * m, -half * m, half * m, planes.low * m,
                                 planes.high * m)
               : glm::perspectiveRH_ZO(2.0 * std::atan(half), aspect, planes.low * m, planes.high * m);
}

glm::dmat4 viewFrom(const glm::dvec3& eye, const glm::dmat3& axes) {
    glm::dmat4 view(glm::transpose(axes));
    view[3] = glm::dvec4(-(glm::transpose(axes) * eye), 1.0);
    return view;
}

} // namespace

std::string sightProblem(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up) {
    const double distance = glm::length(target - eye), length = glm::length(up);
    const double size = std::max(glm::length(eye), glm::length(target));
    if (!std::isfinite(distance) || !std::isfinite(length))
        return "the camera's position, its target or its up direction is beyond what numbers can hold";
    if (!(distance > 1e-12 * size))
        return "the camera stands at the point that it looks at";
    if (!(length > 0.0))
        return "the up direction has no length";
    if (!(glm::length(glm::cross((target - eye) / distance, up / length)) > kLeastSine))
        return "the up direction is parallel to the direction of sight";
    return {};
}

SceneCamera lookAt(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up, double fovY) {
    SceneCamera camera;
    camera.index = -1;
    camera.eye = eye;
    const glm::dvec3 back = glm::normalize(eye - target);
    const glm::dvec3 right = glm::normalize(glm::cross(glm::normalize(up), back));
    camera.axes = {right, glm::cross(back, right), back};
    camera.fovY = fovY;
    return camera;
}

glm::dvec3 usualUp(const glm::dvec3& eye, const glm::dvec3& target) {
    const glm::dvec3 up(0.0, 1.0, 0.0);
    if (sightProblem(eye, target, up).empty())
        return up;
    return {0.0, 0.0, eye.y > target.y ? -1.0 : 1.0};
}

View viewOf(const SceneCamera& camera, const Similarity& workspaceFromScene, const Bounds& sceneBounds,
            double aspect) {
    const glm::dmat3 axes = glm::mat3_cast(workspaceFromScene.rotation) * camera.axes;
    View view;
    view.viewFromWorkspace = viewFrom(workspaceFromScene.point(camera.eye), axes);
    view.clipFromView = projection(camera, planesOf(camera, sceneBounds), aspect, workspaceFromScene.scale);
    view.workspaceFromScene = workspaceFromScene;
    placeLights(axes[0], axes[1], axes[2], view);
    return view;
}

std::string unseenBecause(const SceneCamera& camera, const Bounds& sceneBounds, double aspect, int height) {
    if (sceneBounds.empty())
        return "the model has nothing to draw";
    const double half = halfFrame(camera, aspect);
    glm::bvec3 allBeyondLow(true), allBeyondHigh(true);
    Bounds seen;
    for (const glm::dvec3& corner : cornersOf(sceneBounds)) {
        const glm::dvec3 p = glm::transpose(camera.axes) * (corner - camera.eye);
        const double reach = camera.orthographic ? half : half * -p.z; // of the picture at that depth
        const glm::dvec3 low(-reach * aspect, -reach, -camera.farPlane),
            high(reach * aspect, reach, -camera.nearPlane);
        allBeyondLow = glm::bvec3(allBeyondLow.x && p.x < low.x, allBeyondLow.y && p.y < low.y,
                                  allBeyondLow.z && p.z < low.z);
        allBeyondHigh = glm::bvec3(allBeyondHigh.x && p.x > high.x, allBeyondHigh.y && p.y > high.y,
                                   allBeyondHigh.z && p.z > high.z);
        seen.include(p / (reach > 0.0 ? reach : 1e-300));
    }
    if (allBeyondHigh.z)
        return camera.nearPlane > 0.0 ? "the model lies behind the camera or before its near plane"
                                      : "the model lies behind the camera";
    if (allBeyondLow.z)
        return "the model lies beyond the camera's far plane";
    if (glm::any(allBeyondLow) || glm::any(allBeyondHigh))
        return "the model lies beside the picture";
    if (0.5 * height * std::max(seen.extent().x, seen.extent().y) < 1.0)
        return "the model is smaller than a pixel from there";
    return {};
}

} // namespace touchstone

#include "workbench/commands/render_camera.h"

#include "engine/core/error.h"
#include "renderer/scene_camera.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace touchstone {

namespace {

/// Farther away float positions in the eye frame are off by pixels.
constexpr double kFarthest = 1e4; // of the model's diagonals

std::string nameOf(const SceneCamera& camera) {
    return std::to_string(camera.index) + (camera.name.empty() ? "" : " " + camera.name) +
           (camera.nodeName.empty() || camera.nodeName == camera.name ? ""
                                                                      : " at the node " + camera.nodeName) +
           (camera.orthographic ? " (orthographic)" : " (perspective)");
}

const SceneCamera& cameraOfFile(const Scene& scene, const std::string& name) {
    const auto with = [&](const auto& key) {
        return std::ranges::find_if(scene.cameras,
                                    [&](const SceneCamera& camera) { return key(camera) == name; });
    };
    auto found = with([](const SceneCamera& camera) { return camera.name; });
    if (found == scene.cameras.end())
        found = with([](const SceneCamera& camera) { return camera.nodeName; });
    if (found == scene.cameras.end())
        found = with([](const SceneCamera& camera) { return std::to_string(camera.index); });
    if (!name.empty() && found != scene.cameras.end())
        return *found;
    constexpr size_t kListed = 20;
    std::string all;
    for (size_t i = 0; i < std::min(kListed, scene.cameras.size()); ++i)
        all += (i == 0 ? "" : ", ") + nameOf(scene.cameras[i]);
    if (scene.cameras.size() > kListed)
        all += ", ...";
    throw Error(scene.path, "cameras", "there is no camera '" + name + "'",
                all.empty() ? "the scene has none: use --from or --camera-position"
                            : "choose one of: " + all);
}

SceneCamera placedCamera(const CameraOptions& options, const Bounds& bounds, double fov) {
    const glm::dvec3 eye = *options.position;
    const glm::dvec3 target = options.target.value_or(bounds.empty() ? glm::dvec3(0.0) : bounds.centre());
    const glm::dvec3 up = options.up.value_or(usualUp(eye, target));
    if (const std::string problem = sightProblem(eye, target, up); !problem.empty())
        throw Error("--camera-position", "", problem, "give another --camera-position, --look-at or --up");
    SceneCamera camera = lookAt(eye, target, up, fov);
    camera.halfHeight = glm::distance(eye, target) * std::tan(0.5 * fov); // if it is orthographic
    return camera;
}

View viewFrom(const SceneCamera& camera, const Model& model, const glm::ivec2& size, const Bounds& drawn) {
    const Bounds& bounds = model.scene->bounds;
    const double aspect = static_cast<double>(size.x) / size.y;
    if (!bounds.empty() && !(glm::distance(camera.eye, bounds.centre()) <= kFarthest * bounds.diagonal()))
        throw Error("camera", "", "stands more than 10,000 times the model's size away from it",
                    "move it nearer: `touchstone inspect` tells the model's bounds");
    if (const std::string why = unseenBecause(camera, bounds, aspect, size.y); !why.empty())
        std::fprintf(stderr, "touchstone: warning: the picture shows nothing of the model: %s\n",
                     why.c_str());
    return viewOf(camera, model.workspaceFromScene, drawn, aspect);
}

} // namespace

View chosenView(const CameraOptions& options, const Model& model, const glm::ivec2& size,
                const Bounds& drawn) {
    if (options.name)
        return viewFrom(cameraOfFile(*model.scene, *options.name), model, size, drawn);
    OrbitCamera camera;
    const double fov = options.fov ? glm::radians(*options.fov) : camera.fovY;
    if (options.position) {
        SceneCamera placed = placedCamera(options, model.scene->bounds, fov);
        placed.orthographic = options.orthographic;
        return viewFrom(placed, model, size, drawn);
    }
    const double aspect = static_cast<double>(size.x) / size.y;
    camera = OrbitCamera::threeQuarter(workspaceBounds(model), aspect);
    if (options.side)
        camera.lookFrom(*options.side);
    camera.fovY = fov;
    camera.orthographic = options.orthographic;
    camera.frame(workspaceBounds(model), aspect);
    return viewOf(camera, model.workspaceFromScene, aspect);
}

} // namespace touchstone

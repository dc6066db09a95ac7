#include "renderer/view.h"

namespace touchstone {

View viewOf(const OrbitCamera& camera, const Similarity& workspaceFromScene, double aspect) {
    View view;
    view.viewFromWorkspace = camera.viewFromWorkspace();
    view.clipFromView = camera.clipFromView(aspect);
    view.workspaceFromScene = workspaceFromScene;
    placeLights(camera.right(), camera.up(), -camera.forward(), view);
    return view;
}

void placeLights(const glm::dvec3& right, const glm::dvec3& up, const glm::dvec3& back, View& view) {
    view.lights[0] = {-0.55 * right + 0.75 * up + 0.8 * back, glm::vec3(1.35f, 1.3f, 1.23f)};
    // A large lamp beside the key light, and a narrow one that outlines the right edge of round objects.
    view.surroundings.lamps[0] = {-0.75 * right + 0.55 * up + 0.55 * back, glm::vec3(4.2f, 4.1f, 3.95f),
                                  14.0};
    view.surroundings.lamps[1] = {1.0 * right + 0.25 * up + 0.1 * back, glm::vec3(1.8f, 1.95f, 2.2f), 14.0};
}

} // namespace touchstone

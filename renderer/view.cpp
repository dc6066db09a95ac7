#include "renderer/view.h"

namespace touchstone {

View viewOf(const OrbitCamera& camera, const Similarity& workspaceFromScene, double aspect) {
    View view;
    view.viewFromWorkspace = camera.viewFromWorkspace();
    view.clipFromView = camera.clipFromView(aspect);
    view.workspaceFromScene = workspaceFromScene;
    const glm::dvec3 right = camera.right(), up = camera.up(), back = -camera.forward();
    view.lights[0] = {-0.55 * right + 0.75 * up + 0.8 * back, glm::vec3(2.6f, 2.5f, 2.36f)};
    view.lights[1] = {1.0 * right + 0.1 * up + 0.25 * back, glm::vec3(0.6f, 0.68f, 0.8f)};
    return view;
}

} // namespace touchstone

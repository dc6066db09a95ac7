#include "workbench/figures/quantity.h"
#include "workbench/panels/panels.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace touchstone {

namespace {

/// Through the middle of the model.
ClipPlane planeAlong(const Scene& scene, const glm::dvec3& normal) {
    const glm::dvec3 centre = scene.bounds.empty() ? glm::dvec3(0.0) : scene.bounds.centre();
    return {normal, glm::dot(normal, centre)};
}

/// Towards the eye, scene frame: what lies before the plane is cut away.
glm::dvec3 towardsEye(const PanelInput& input) {
    const glm::dvec3 back = -input.camera.forward();
    return input.haptic != nullptr ? glm::conjugate(input.haptic->workspaceFromScene.rotation) * back : back;
}

/// Low and high offset of planes that meet the model.
glm::dvec2 rangeOf(const Bounds& bounds, const glm::dvec3& normal) {
    const double half = 0.5 * glm::dot(glm::abs(normal), bounds.extent());
    const double middle = glm::dot(normal, bounds.empty() ? glm::dvec3(0.0) : bounds.centre());
    return {middle - half, middle + half};
}

void directions(const PanelInput& input, ClipPlane& plane, Widgets& widgets) {
    struct Choice {
        const char *name, *label;
        glm::dvec3 normal;
    };
    const std::array choices{Choice{"clip:x", "X", {1, 0, 0}}, Choice{"clip:y", "Y", {0, 1, 0}},
                             Choice{"clip:z", "Z", {0, 0, 1}},
                             Choice{"clip:view", "View", towardsEye(input)}};
    for (const Choice& choice : choices) {
        if (widgets.button(choice.name, choice.label))
            plane = planeAlong(*input.scene, choice.normal);
        ImGui::SameLine();
    }
    if (widgets.button("clip:flip", "Other side"))
        plane = {-plane.normal, -plane.offset};
}

} // namespace

void toggleClip(const PanelInput& input, PanelState& state) {
    std::optional<ClipPlane>& clip = state.view.part.clip;
    if (clip)
        clip.reset();
    else if (input.scene != nullptr)
        clip = planeAlong(*input.scene, towardsEye(input));
}

void drawClip(const PanelInput& input, PanelState& state, Widgets& widgets) {
    std::optional<ClipPlane>& clip = state.view.part.clip;
    bool on = clip.has_value();
    if (widgets.check("clip", "Clipping plane (Alt+B)", on))
        toggleClip(input, state);
    if (!clip || input.scene == nullptr)
        return;
    directions(input, *clip, widgets);
    const glm::dvec2 range = rangeOf(input.scene->bounds, clip->normal);
    if (!(range[1] > range[0]))
        return;
    const ShownUnit unit = shownUnit(std::max(std::abs(range[0]), std::abs(range[1])), "m");
    auto place = static_cast<float>((clip->offset - range[0]) / (range[1] - range[0]));
    ImGui::SetNextItemWidth(-1.0f);
    if (widgets.slider("clip:place", "Place", place, {0.0f, 1.0f, false, true}, quantity(clip->offset, unit)))
        clip->offset = range[0] + static_cast<double>(place) * (range[1] - range[0]);
}

} // namespace touchstone

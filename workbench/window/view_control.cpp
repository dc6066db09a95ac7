#include "workbench/window/view_control.h"

#include <imgui.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cmath>

namespace touchstone {

namespace {

constexpr double kOrbitPerPixel = 0.008; // rad
constexpr double kZoomPerNotch = 0.9;
constexpr double kClearance = 0.012;                   // m between model and resting hand
constexpr double kFirstYaw = 0.45, kFirstPitch = 0.35; // rad: from the right and above, so depth shows

} // namespace

void ViewControl::lookAt(const Bounds& bounds, double aspect) {
    bounds_ = bounds;
    camera_ = OrbitCamera{};
    camera_.yaw = kFirstYaw;
    camera_.pitch = kFirstPitch;
    camera_.frame(bounds, aspect);
    const glm::dvec3 centre = bounds.empty() ? glm::dvec3(0.0) : bounds.centre();
    hand_ = MouseHand(centre + glm::dvec3(0.0, 0.0, 0.5 * bounds.extent().z + kClearance));
}

void ViewControl::update(const glm::dvec2& area) {
    const ImGuiIO& io = ImGui::GetIO();
    const glm::dvec2 moved(static_cast<double>(io.MouseDelta.x), static_cast<double>(io.MouseDelta.y));
    const ViewAxes axes{camera_.right(), camera_.up(), camera_.forward()};
    if (!io.WantCaptureKeyboard && ImGui::IsKeyPressed(GLFW_KEY_HOME))
        camera_.frame(bounds_, area.x / area.y);
    if (io.WantCaptureMouse)
        return;
    if (io.MouseDown[0]) {
        const glm::dvec3 along = camera_.viewPlaneDisplacement(moved, area.y, hand_.goal());
        hand_.drag(axes, glm::dot(along, axes.right), glm::dot(along, axes.up));
    }
    if (io.MouseDown[1])
        camera_.orbit(-kOrbitPerPixel * moved.x, kOrbitPerPixel * moved.y);
    if (io.MouseDown[2])
        camera_.pan(moved, area.y);
    if (io.MouseWheel != 0.0f) {
        const auto notches = static_cast<double>(io.MouseWheel);
        if (io.KeyCtrl)
            camera_.zoom(std::pow(kZoomPerNotch, notches));
        else
            hand_.push(axes, notches * kWheelDepth * (io.KeyShift ? 0.1 : 1.0));
    }
}

} // namespace touchstone

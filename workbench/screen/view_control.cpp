#include "workbench/screen/view_control.h"

#include "haptics/shape/field/sculpt/live_tool.h"
#include "workbench/screen/keys.h"

#include <imgui.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace touchstone {

namespace {

constexpr double kOrbitPerPixel = 0.008; // rad
constexpr double kZoomPerNotch = 0.9;
constexpr double kZoomPerPixel = 0.99;
constexpr double kKeyOrbit = 1.2;      // rad/s
constexpr double kKeyPan = 400.0;      // pixels/s
constexpr double kKeyZoom = 0.4;       // fraction of the distance left after one second
constexpr double kTurntable = 0.5;     // rad/s: one turn in 12.6 s
constexpr double kProbeDistance = 0.6; // scene radii, for the view of the probe
constexpr double kClearance = 0.012;   // m between model and hand at rest

/// The camera move of a key, as in Blender: 1, 3, 7, and with Ctrl the opposite side.
std::optional<CameraMove> keyMove(bool homeIsTaken, bool fIsTaken) {
    const bool opposite = ImGui::GetIO().KeyCtrl;
    const auto side = [&](char digit, int pad) {
        return opposite ? ctrlPressed(digit) || ctrlPressed(pad) : keyPressed({digit, pad});
    };
    if ((!fIsTaken && keyPressed(keyOf('f'))) || (!homeIsTaken && keyPressed(GLFW_KEY_HOME)))
        return CameraMove::Fit;
    if (side('1', GLFW_KEY_KP_1))
        return opposite ? CameraMove::Back : CameraMove::Front;
    if (side('3', GLFW_KEY_KP_3))
        return opposite ? CameraMove::Left : CameraMove::Right;
    if (side('7', GLFW_KEY_KP_7))
        return opposite ? CameraMove::Bottom : CameraMove::Top;
    if (keyPressed({keyOf('.'), GLFW_KEY_KP_DECIMAL}))
        return CameraMove::Probe;
    return std::nullopt;
}

/// Those of the mouse's hand.
uint32_t buttonsOf(const ViewControl::Situation& now, bool pressed) {
    return (now.sculpts || now.grasps) && pressed ? kSculptButton : 0;
}

void optionKeys(ViewOptions& options) {
    if (keyPressed(keyOf('t')))
        options.turntable = !options.turntable;
    if (keyPressed(keyOf('g')))
        options.freeHand = !options.freeHand;
    if (keyPressed(keyOf('v'))) {
        const size_t step = ImGui::GetIO().KeyShift ? kViewModeNames.size() - 1 : 1;
        options.mode =
            static_cast<ViewMode>((static_cast<size_t>(options.mode) + step) % kViewModeNames.size());
    }
    if (keyPressed(keyOf('z')))
        options.wireframe = !options.wireframe;
    if (keyPressed(keyOf('l')))
        options.grid = !options.grid;
    if (keyPressed(keyOf('x'))) // none, across x, y, z
        options.slice.axis = options.slice.axis < 2 ? options.slice.axis + 1 : -1;
    if (keyPressed({keyOf('5'), GLFW_KEY_KP_5}))
        options.orthographic = !options.orthographic;
    if (keyPressed(keyOf('m')))
        options.magnifier = !options.magnifier;
    if (keyPressed(keyOf('o')))
        options.overlays = options.overlays.probe ? ShownOverlays{false, false, false, false, false, false}
                                                  : ShownOverlays{};
    if (keyPressed(GLFW_KEY_F12))
        options.savePicture = true;
}

} // namespace

void ViewControl::lookAt(const Bounds& bounds, double aspect) {
    bounds_ = bounds;
    camera_ = OrbitCamera::threeQuarter(bounds, aspect);
    const glm::dvec3 centre = bounds.empty() ? glm::dvec3(0.0) : bounds.centre();
    hand_ = MouseHand(centre + glm::dvec3(0.0, 0.0, 0.5 * bounds.extent().z + kClearance));
    over_ = hand_.goal();
    pressed_ = {.press = 0.0};
    lift(); // from where the previous model was touched
    pressing_ = armed_ = false;
}

std::optional<MouseGoal> ViewControl::handGoal() const {
    if (lifted_ > 0.0)
        return std::nullopt;
    MouseGoal goal = pressed_;
    goal.position = goal.object >= 0 ? pointedAt_.inversePoint(hand_.goal()) : hand_.goal();
    return goal;
}

void ViewControl::go(CameraMove move, const Situation& now) {
    const auto look = [&](Side side) {
        camera_.lookFrom(side);
        camera_.frame(bounds_, now.area.x / now.area.y);
    };
    switch (move) {
    case CameraMove::Fit:
        return camera_.frame(bounds_, now.area.x / now.area.y);
    case CameraMove::Front:
        return look(Side::Front);
    case CameraMove::Back:
        return look(Side::Back);
    case CameraMove::Right:
        return look(Side::Right);
    case CameraMove::Left:
        return look(Side::Left);
    case CameraMove::Top:
        return look(Side::Top);
    case CameraMove::Bottom:
        return look(Side::Bottom);
    case CameraMove::Probe:
        camera_.target = now.probe;
        camera_.distance = kProbeDistance * camera_.sceneRadius;
    }
}

void ViewControl::update(const Situation& now, ViewOptions& options) {
    armed_ = armed_ || !ImGui::GetIO().MouseDown[0]; // wherever the pointer is
    putDown_ = lifted_ > 0.0 && lifted_ <= now.seconds;
    lifted_ = std::max(0.0, lifted_ - now.seconds);
    if (!now.covered) {
        if (const std::optional<CameraMove> move = keyMove(now.looksBack, now.sculpts))
            options.move = move;
        optionKeys(options);
        if (!ImGui::GetIO().WantTextInput)
            turnWithKeys(now);
    }
    camera_.orthographic = options.orthographic;
    if (options.move)
        go(*std::exchange(options.move, std::nullopt), now);
    if (options.turntable)
        camera_.orbit(kTurntable * now.seconds, 0.0);
    if (!ImGui::GetIO().WantCaptureMouse)
        turnWithPointer(now, options);
    if (pressing_ && (ImGui::GetIO().WantCaptureMouse || !ImGui::GetIO().MouseDown[0]))
        letGo();
}

void ViewControl::letGo() {
    pressing_ = false;
    pressed_.buttons = 0;
    hand_.pointAt({.point = over_, .normal = glm::dvec3(0.0)}, {.force = 0.0});
    pressed_.press = 0.0;
}

/// Arrows orbit, with Shift they pan; plus and minus zoom.
void ViewControl::turnWithKeys(const Situation& now) {
    if (ImGui::GetIO().WantCaptureKeyboard)
        return;
    const double right = now.looksBack ? 0.0 : keyAxis({GLFW_KEY_LEFT}, {GLFW_KEY_RIGHT}),
                 up = keyAxis({GLFW_KEY_DOWN}, {GLFW_KEY_UP});
    if (ImGui::GetIO().KeyShift)
        camera_.pan(kKeyPan * now.seconds * glm::dvec2(-right, up), now.area.y);
    else
        camera_.orbit(kKeyOrbit * now.seconds * right, kKeyOrbit * now.seconds * up);
    // On a US keyboard plus is Shift with the key of the equals sign.
    const double nearer = keyAxis({keyOf('-'), GLFW_KEY_KP_SUBTRACT},
                                  {keyOf('+') == '+' ? keyOf('=') : keyOf('+'), GLFW_KEY_KP_ADD});
    if (nearer != 0.0 && !ImGui::GetIO().KeyCtrl) // with Ctrl they change the UI scale
        camera_.zoom(std::pow(kKeyZoom, nearer * now.seconds));
}

void ViewControl::turnWithPointer(const Situation& now, ViewOptions& options) {
    const ImGuiIO& io = ImGui::GetIO();
    const glm::dvec2 moved(static_cast<double>(io.MouseDelta.x), static_cast<double>(io.MouseDelta.y));
    const auto notches = static_cast<double>(io.MouseWheel);
    // Alt with the left button moves the camera, for mice with one button.
    const bool leftIsHand = now.mouseIsHand && !io.KeyAlt;
    if (io.MouseDown[1] || io.MouseDown[2] || (io.MouseDown[0] && !leftIsHand)) {
        if (io.KeyShift)
            camera_.pan(moved, now.area.y);
        else if (io.KeyCtrl)
            camera_.zoom(std::pow(kZoomPerPixel, -moved.y));
        else
            camera_.orbit(-kOrbitPerPixel * moved.x, kOrbitPerPixel * moved.y);
    }
    if (notches != 0.0 && (io.KeyCtrl || !now.mouseIsHand))
        camera_.zoom(std::pow(kZoomPerNotch, notches));
    if (!now.mouseIsHand)
        return;
    if (options.freeHand || !now.look) {
        pressed_ = {.press = INFINITY, .buttons = buttonsOf(now, ImGui::GetIO().MouseDown[0])};
        moveFreeHand(now);
        over_ = hand_.goal();
        return;
    }
    if (notches != 0.0 && !io.KeyCtrl)
        options.press = std::clamp(options.press * std::pow(kWheelPress, notches), kMinPress, kMaxPress);
    if (!io.MouseDown[1] && !io.MouseDown[2] && !io.KeyAlt)
        pointHand(now, options);
}

/// Dragging with the left button moves the hand in the plane of the view, the wheel in depth.
void ViewControl::moveFreeHand(const Situation& now) {
    const ImGuiIO& io = ImGui::GetIO();
    const ViewAxes axes{camera_.right(), camera_.up(), camera_.forward()};
    if (io.MouseDown[0] && !io.KeyAlt) {
        const glm::dvec2 moved(static_cast<double>(io.MouseDelta.x), static_cast<double>(io.MouseDelta.y));
        const glm::dvec3 along = camera_.viewPlaneDisplacement(moved, now.area.y, hand_.goal());
        hand_.drag(axes, glm::dot(along, axes.right), glm::dot(along, axes.up));
    }
    if (io.MouseWheel != 0.0f && !io.KeyCtrl)
        hand_.push(axes, static_cast<double>(io.MouseWheel) * kWheelDepth * (io.KeyShift ? 0.1 : 1.0));
}

/// The hand hovers over what lies under the pointer; the left button presses.
void ViewControl::pointHand(const Situation& now, const ViewOptions& options) {
    const ImGuiIO& io = ImGui::GetIO();
    const glm::dvec2 pointer(static_cast<double>(io.MousePos.x), static_cast<double>(io.MousePos.y));
    if (!ImGui::IsMousePosValid())
        return;
    const Ray picker = camera_.rayThroughPixel(pointer - now.origin, now.area);
    if (const std::optional<PointedSurface> seen = now.look(picker)) {
        const PointedSurface surface = withRoom(now, *seen);
        liftWhereBlocked(now, MouseHand::hoverOver(surface));
        // It returns in the air before it presses.
        pressing_ = io.MouseDown[0] && armed_ && !putDown_;
        pressed_ = {.object = surface.object,
                    .press = pressing_ ? options.press : 0.0,
                    .stiffness = surface.stiffness,
                    .stiffest = surface.stiffest,
                    .friction = surface.friction,
                    .grip = surface.grip,
                    .buttons = buttonsOf(now, pressing_)};
        pointedAt_ = surface.workspaceFromObject;
        return hand_.pointAt(surface, {.force = pressing_ ? options.press : 0.0});
    }
    pressed_ = {.press = 0.0};
    hand_.pointPast({camera_.right(), camera_.up(), camera_.forward()}, picker.origin, picker.direction);
    liftWhereBlocked(now, hand_.goal());
}

/// Between two facing surfaces the hand stays in the middle.
PointedSurface ViewControl::withRoom(const Situation& now, const PointedSurface& surface) {
    constexpr double kOff = 1e-6; // m: excludes the surface itself
    PointedSurface with = surface;
    const Ray out{surface.point + kOff * surface.normal, surface.normal};
    if (const std::optional<PointedSurface> facing = now.look(out))
        with.room = glm::distance(facing->point, surface.point);
    return with;
}

/// The pointer jumps, but a hand must travel. Where the straight path leads through the model, round an edge
/// or from one part to another, the hand is lifted off and put down at the new point, for long enough that
/// touch restarts. Dragged through, it would stay on the side that it came from.
void ViewControl::liftWhereBlocked(const Situation& now, const glm::dvec3& to) {
    const glm::dvec3 from = std::exchange(over_, to), way = to - from;
    const double length = glm::length(way);
    if (!(length > 0.0))
        return;
    const std::optional<PointedSurface> met = now.look({from, way / length});
    if (met && glm::distance(met->point, from) < length)
        lift();
}

} // namespace touchstone

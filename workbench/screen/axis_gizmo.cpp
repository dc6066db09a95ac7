#include "workbench/screen/axis_gizmo.h"

#include <imgui.h>

#include <algorithm>
#include <array>

namespace touchstone {

namespace {

constexpr float kSide = 92.0f, kArm = 33.0f, kEnd = 8.5f, kMargin = 8.0f; // layout units

struct End {
    const char *label, *name;
    glm::dvec3 direction; ///< workspace
    CameraMove move;      ///< to the side where it is
    ImU32 color;
    glm::vec2 place{}; ///< of its middle from that of the gizmo, units, y down
    double towards = 0.0;
};

/// From the farthest to the nearest.
std::array<End, 6> endsOf(const OrbitCamera& camera) {
    constexpr ImU32 kX = IM_COL32(226, 86, 88, 255), kY = IM_COL32(122, 190, 84, 255),
                    kZ = IM_COL32(86, 140, 232, 255);
    std::array<End, 6> ends{{{"X", "axis:+x", {1, 0, 0}, CameraMove::Right, kX},
                             {"", "axis:-x", {-1, 0, 0}, CameraMove::Left, kX},
                             {"Y", "axis:+y", {0, 1, 0}, CameraMove::Top, kY},
                             {"", "axis:-y", {0, -1, 0}, CameraMove::Bottom, kY},
                             {"Z", "axis:+z", {0, 0, 1}, CameraMove::Front, kZ},
                             {"", "axis:-z", {0, 0, -1}, CameraMove::Back, kZ}}};
    for (End& end : ends) {
        end.place = kArm * glm::vec2(static_cast<float>(glm::dot(end.direction, camera.right())),
                                     static_cast<float>(-glm::dot(end.direction, camera.up())));
        end.towards = -glm::dot(end.direction, camera.forward());
    }
    std::ranges::stable_sort(ends, {}, &End::towards);
    return ends;
}

ImVec2 at(const glm::vec2& p) {
    return {p.x, p.y};
}

/// The axis +z looks from the front: its opposite end lies behind it.
void paint(ImDrawList& draw, const std::array<End, 6>& ends, const glm::vec2& middle, float scale,
           const char* hovered) {
    for (const End& end : ends) {
        const glm::vec2 place = middle + scale * end.place;
        const float radius = kEnd * scale;
        if (*end.label != '\0')
            draw.AddLine(at(middle), at(place), end.color, 2.0f * scale);
        if (*end.label == '\0') {
            draw.AddCircleFilled(at(place), 0.75f * radius, IM_COL32(30, 33, 37, 190));
            draw.AddCircle(at(place), 0.75f * radius, end.color, 0, 1.5f * scale);
        } else {
            draw.AddCircleFilled(at(place), radius, end.color);
            const ImVec2 size = ImGui::CalcTextSize(end.label);
            draw.AddText(ImVec2(place.x - 0.5f * size.x, place.y - 0.5f * size.y), IM_COL32(16, 18, 20, 255),
                         end.label);
        }
        if (end.name == hovered)
            draw.AddCircle(at(place), radius + 2.0f * scale, IM_COL32(255, 255, 255, 220), 0, 1.5f * scale);
    }
}

glm::vec2 middleAt(const glm::vec2& corner, float scale) {
    return corner + scale * glm::vec2(-kMargin - 0.5f * kSide, kMargin + 0.5f * kSide);
}

/// Of the ends under the pointer the nearest to the eye, which lies above the others; `otherwise` at a
/// corner.
const End& nearestUnderMouse(const std::array<End, 6>& ends, const End& otherwise, const glm::vec2& middle,
                             float scale) {
    const glm::vec2 mouse(ImGui::GetIO().MousePos.x, ImGui::GetIO().MousePos.y);
    const auto found = std::find_if(ends.rbegin(), ends.rend(), [&](const End& end) {
        return glm::distance(mouse, middle + scale * end.place) <= kEnd * scale;
    });
    return found == ends.rend() ? otherwise : *found;
}

} // namespace

std::optional<CameraMove> drawAxisGizmo(const OrbitCamera& camera, const glm::vec2& corner, float scale,
                                        const std::function<void(const char*)>& mark) {
    const glm::vec2 middle = middleAt(corner, scale);
    const std::array<End, 6> ends = endsOf(camera);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0.0f, 0.0f));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1.0f, 1.0f));
    // A window for each end: what lies between them belongs to the picture. Failed: one window that took the
    // mouse only while it was over an end learned of it a frame late, and a click within one frame was lost.
    std::optional<CameraMove> chosen;
    const char* hovered = nullptr;
    const float half = kEnd * scale;
    for (const End& end : ends) {
        const glm::vec2 low = middle + scale * end.place - half;
        ImGui::SetNextWindowPos(at(low));
        ImGui::SetNextWindowSize(ImVec2(2.0f * half, 2.0f * half));
        ImGui::Begin(end.name, nullptr,
                     ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoBackground |
                         ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                         ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav);
        ImGui::SetCursorScreenPos(at(low));
        const bool clicked = ImGui::InvisibleButton("look", ImVec2(2.0f * half, 2.0f * half));
        if (clicked || ImGui::IsItemHovered()) {
            const End& nearest =
                nearestUnderMouse(ends, end, middle, scale); // the windows' order is not the ends'
            hovered = nearest.name;
            if (clicked)
                chosen = nearest.move;
        }
        mark(end.name);
        ImGui::End();
    }
    ImGui::PopStyleVar(2);
    paint(*ImGui::GetBackgroundDrawList(), ends, middle, scale, hovered);
    return chosen;
}

void paintAxes(const OrbitCamera& camera, const glm::vec2& corner, float scale) {
    paint(*ImGui::GetBackgroundDrawList(), endsOf(camera), middleAt(corner, scale), scale, nullptr);
}

} // namespace touchstone

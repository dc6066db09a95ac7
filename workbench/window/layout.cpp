#include "workbench/window/layout.h"

#include "workbench/panels/budget_panel.h"
#include "workbench/panels/colors.h"
#include "workbench/panels/error_panel.h"
#include "workbench/panels/file_panel.h"
#include "workbench/panels/panels.h"
#include "workbench/timeline/timeline_controller.h"
#include "workbench/window/panel_keys.h"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <utility>

namespace touchstone {

namespace {

// Units of layout.
constexpr float kBar = 42.0f, kIntroduction = 44.0f;
constexpr float kMinWidth = 320.0f, kMinHeight = 180.0f; // of the picture
constexpr float kMinBottom = 120.0f;
constexpr float kFolded = 23.0f; // width of a folded panel: the arrow that unfolds it

// Without a background: the cleared colour is the same, and a software device fills slowly.
constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoTitleBar |
                                    ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                                    ImGuiWindowFlags_NoBringToFrontOnFocus;

struct Rect {
    float x, y, width, height;
};

/// Of all that lies above the picture.
float topOf(const PanelState& state) {
    return kBar + (state.introduced ? 0.0f : kIntroduction);
}

/// A panel in its place, or the arrow that unfolds it. `out`, `in`: directions of the arrows. True where it
/// was pressed.
template <class Content>
bool panel(const char* name, const Rect& rect, bool folded, ImGuiDir out, ImGuiDir in, Widgets& widgets,
           const Content& content) {
    ImGui::SetNextWindowPos(ImVec2(rect.x, rect.y));
    ImGui::SetNextWindowSize(ImVec2(rect.width, rect.height));
    if (folded) {
        ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0.0f, 0.0f));
        ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1.0f, 1.0f));
    }
    ImGui::Begin(name, nullptr, folded ? kFixed | ImGuiWindowFlags_NoScrollbar : kFixed);
    if (folded)
        ImGui::PopStyleVar(2);
    const float side = ImGui::GetFrameHeight();
    const ImVec2 begin = ImGui::GetCursorPos();
    if (folded)
        ImGui::SetCursorPos(ImVec2(0.5f * (rect.width - std::min(rect.width, side)), 0.0f));
    else // on the first line, right; that of a side panel is plain text, above a line
        ImGui::SetCursorPos(
            ImVec2(ImGui::GetWindowContentRegionMax().x - side,
                   begin.y - (in == ImGuiDir_Down ? 0.0f : ImGui::GetStyle().FramePadding.y)));
    const bool pressed = ImGui::ArrowButton("##fold", folded ? out : in);
    widgets.mark((std::string("fold:") + name).c_str());
    if (!folded) {
        ImGui::SetCursorPos(begin);
        content();
    }
    ImGui::End();
    return pressed;
}

void topBar(const PanelInput& input, PanelState& state, const Rect& rect, Widgets& widgets) {
    ImGui::SetNextWindowPos(ImVec2(rect.x, rect.y));
    ImGui::SetNextWindowSize(ImVec2(rect.width, rect.height));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(widgets.units(12.0f), widgets.units(7.0f)));
    ImGui::Begin("bar", nullptr, kFixed | ImGuiWindowFlags_NoScrollbar);
    ImGui::PopStyleVar();
    drawTopBar(input, state, widgets);
    ImGui::End();
}

void leftPanel(const PanelInput& input, PanelState& state, Widgets& widgets) {
    ImGui::TextDisabled("HAND");
    ImGui::Separator();
    drawHand(input, state, widgets);
    widgets.section("SCULPT");
    drawSculpt(input, state, widgets);
    widgets.section("SCENE");
    drawScene(input, state, widgets);
    widgets.section("UNDER THE PROBE");
    drawTouched(input, state, widgets);
}

void rightPanel(const PanelInput& input, PanelState& state, Widgets& widgets) {
    ImGui::TextDisabled("FELT NOW");
    ImGui::Separator();
    drawNow(input, state, widgets);
    drawSound(input, state, widgets);
    widgets.section("WHAT A TICK COSTS");
    drawBudget(*input.servo, widgets);
    widgets.section("HOW FAR FROM EXACT");
    drawError(input.servo->error, widgets);
    widgets.section("HOW IT IS DONE");
    drawConfigurations(state, widgets);
    widgets.section("SERVO");
    drawServo(input, widgets);
}

struct SizeRange {
    float least, most, usual; // units of layout; `most` may be less than `least`
};

/// An edge of the picture, `grip`: drags the size of the panel beyond it, a double click restores that.
/// `dragged`: the size that the pointer asks for, window coordinates.
void dragEdge(const char* name, const Rect& grip, float dragged, const SizeRange& range, float& size,
              Widgets& widgets) {
    const bool upright = grip.height > grip.width;
    ImGui::SetNextWindowPos(ImVec2(grip.x, grip.y));
    ImGui::SetNextWindowSize(ImVec2(grip.width, grip.height));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0.0f, 0.0f));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1.0f, 1.0f));
    ImGui::Begin(name, nullptr, (kFixed | ImGuiWindowFlags_NoNav) & ~ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::PopStyleVar(2);
    ImGui::InvisibleButton("edge", ImVec2(grip.width, grip.height));
    widgets.mark(name);
    if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
        ImGui::SetMouseCursor(upright ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
        const ImVec2 middle(grip.x + 0.5f * grip.width, grip.y + 0.5f * grip.height);
        ImGui::GetWindowDrawList()->AddLine(upright ? ImVec2(middle.x, grip.y) : ImVec2(grip.x, middle.y),
                                            upright ? ImVec2(middle.x, grip.y + grip.height)
                                                    : ImVec2(grip.x + grip.width, middle.y),
                                            ImGui::GetColorU32(ImGuiCol_SeparatorActive), 2.0f);
    }
    if (Widgets::dragged())
        size = std::clamp(dragged / widgets.units(1.0f), range.least, std::max(range.least, range.most));
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0))
        size = range.usual;
    ImGui::End();
}

/// The edges between the picture and the panels that are not folded. `display`: the window's size, `folds`:
/// as shown.
void dragEdges(const PictureRect& picture, const ImVec2& display, const PanelFolds& folds, PanelState& state,
               Widgets& widgets) {
    const float grip = widgets.units(6.0f), unit = widgets.units(1.0f);
    const float below = picture.y + picture.height, beyond = picture.x + picture.width;
    const ImVec2 pointer = ImGui::GetIO().MousePos;
    // Over the picture, since the left panel's scroll bar lies at its edge, and without the lower grip.
    const float height = picture.height - grip;
    if (!folds.left)
        dragEdge("sceneEdge", {picture.x, picture.y, grip, height}, pointer.x,
                 {PanelFolds::kLeftWidth, (beyond / unit) - kMinWidth, PanelFolds::kLeftWidth},
                 state.folds.leftWidth, widgets);
    if (!folds.right)
        dragEdge(
            "feltEdge", {beyond - grip, picture.y, grip, height}, display.x - pointer.x,
            {PanelFolds::kRightWidth, (display.x - picture.x) / unit - kMinWidth, PanelFolds::kRightWidth},
            state.folds.rightWidth, widgets);
    if (!folds.bottom)
        dragEdge("chartsEdge", {picture.x, below - 0.5f * grip, picture.width, grip}, display.y - pointer.y,
                 {kMinBottom, display.y / unit - topOf(state) - kMinHeight, PanelFolds::kBottomHeight},
                 state.folds.bottomHeight, widgets);
}

void bottomPanel(const PanelInput& input, PanelState& state, Widgets& widgets) {
    bool& recording = state.timeline.shown;
    if (widgets.lampButton("live", "Live", !recording, kBlue))
        recording = false;
    ImGui::SameLine();
    if (widgets.lampButton("recorded", "Recorded", recording, kBlue))
        recording = true;
    if (recording)
        return drawTimeline(*input.timeline, state.timeline, widgets);
    drawCharts(input, state, widgets);
}

} // namespace

PanelFolds fittingFolds(const PanelState& state, const glm::vec2& window, float scale) {
    const glm::vec2 units = window / scale;
    PanelFolds fitting = state.folds;
    const auto width = [&] {
        return units.x - (fitting.left ? kFolded : PanelFolds::kLeftWidth) -
               (fitting.right ? kFolded : PanelFolds::kRightWidth);
    };
    fitting.left = fitting.left || width() < kMinWidth;
    fitting.right = fitting.right || width() < kMinWidth;
    // What is left beside the picture's least width goes to the readings first.
    const auto within = [&](float wanted, float least, float others) {
        return std::clamp(wanted, least, std::max(least, units.x - kMinWidth - others));
    };
    fitting.rightWidth =
        within(fitting.rightWidth, PanelFolds::kRightWidth, fitting.left ? kFolded : PanelFolds::kLeftWidth);
    fitting.leftWidth =
        within(fitting.leftWidth, PanelFolds::kLeftWidth, fitting.right ? kFolded : fitting.rightWidth);
    const float room = units.y - topOf(state) - kMinHeight;
    fitting.bottom = fitting.bottom || room < PanelFolds::kBottomHeight;
    fitting.bottomHeight = std::clamp(fitting.bottomHeight, kMinBottom, std::max(kMinBottom, room));
    return fitting;
}

PictureRect pictureRect(const PanelState& state, const glm::vec2& window, float scale) {
    const PanelFolds folds = fittingFolds(state, window, scale);
    const float left = (folds.left ? kFolded : folds.leftWidth) * scale,
                right = (folds.right ? kFolded : folds.rightWidth) * scale,
                bottom = (folds.bottom ? kFolded : folds.bottomHeight) * scale, top = topOf(state) * scale;
    return {left, top, std::max(1.0f, window.x - left - right), std::max(1.0f, window.y - top - bottom)};
}

std::map<std::string, WidgetRect> drawPanels(const PanelInput& input, PanelState& state) {
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    Widgets widgets(input.scale, &state.hovered);
    if (state.hovered.frame + 1 < ImGui::GetFrameCount())
        state.hovered.shown.clear();
    const bool helped = state.help; // before Escape puts it away
    readPanelKeys(input, state);
    if (followController(*input.timeline, state.timeline))
        state.folds.bottom = false;
    const PictureRect picture = pictureRect(state, {display.x, display.y}, input.scale);
    const float below = picture.y + picture.height, beyond = picture.x + picture.width;
    widgets.place("picture", {picture.x, picture.y, picture.width, picture.height});
    const float bar = widgets.units(kBar);
    const PanelFolds folds = fittingFolds(state, {display.x, display.y}, input.scale);
    topBar(input, state, {0.0f, 0.0f, display.x, bar}, widgets);
    if (picture.y > bar)
        drawIntroduction(state, {0.0f, bar, display.x, picture.y - bar}, widgets);
    if (panel("scene", {0.0f, picture.y, picture.x, display.y - picture.y}, folds.left, ImGuiDir_Right,
              ImGuiDir_Left, widgets, [&] { leftPanel(input, state, widgets); }))
        foldSide(state, &PanelFolds::left, &PanelFolds::right, input);
    if (panel("felt", {beyond, picture.y, display.x - beyond, display.y - picture.y}, folds.right,
              ImGuiDir_Left, ImGuiDir_Right, widgets, [&] { rightPanel(input, state, widgets); }))
        foldSide(state, &PanelFolds::right, &PanelFolds::left, input);
    if (panel("charts", {picture.x, below, picture.width, display.y - below}, folds.bottom, ImGuiDir_Up,
              ImGuiDir_Down, widgets, [&] { bottomPanel(input, state, widgets); }))
        state.folds.bottom = !state.folds.bottom;
    dragEdges(picture, display, folds, state, widgets);
    drawCards(input, state, {picture.x, picture.y, picture.width, picture.height}, widgets);
    drawSavedPicture(input, {picture.x, picture.y, picture.width, picture.height}, widgets);
    drawLookingCard(*input.timeline, {picture.x, picture.y, picture.width, picture.height}, widgets);
    drawGallery(input, state, {0.0f, picture.y, display.x, display.y - picture.y}, widgets);
    drawFileDialog(*input.dialog, {0.0f, picture.y, display.x, display.y - picture.y},
                   {picture.x, picture.y, picture.width, picture.height}, helped, widgets);
    drawHelp(input, state, widgets);
    return widgets.take();
}

} // namespace touchstone

#include "workbench/window/panel_keys.h"

#include "workbench/dialog/file_dialog.h"
#include "workbench/figures/ui_scale.h"
#include "workbench/panels/effect_switch.h"
#include "workbench/panels/panels.h"
#include "workbench/screen/keys.h"
#include "workbench/screen/native_key.h"
#include "workbench/timeline/timeline_controller.h"
#include "workbench/window/layout.h"

#include <imgui.h>
#include <imgui_internal.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <optional>

namespace touchstone {

namespace {

void effectKeys(PanelState& state) {
    if (keyPressed(GLFW_KEY_F5))
        kShadingSwitch.toggle(state);
    if (keyPressed(GLFW_KEY_F6))
        kTextureSwitch.toggle(state);
    if (keyPressed(GLFW_KEY_F7))
        kFrictionSwitch.toggle(state);
}

constexpr auto kAnyPopup = ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel;

/// F10 gives the keyboard to the panels until Escape, F10 or a click on the picture: arrows move between
/// widgets, Enter presses, Ctrl+Tab goes to the next panel. Space still switches the force off.
void walk(bool covered, PanelState& state) {
    ImGuiIO& io = ImGui::GetIO();
    if (keyPressed(GLFW_KEY_F10)) {
        state.walking = !state.walking;
        ImGui::SetWindowFocus(state.walking ? "scene" : nullptr);
    }
    if (covered || (ImGui::IsMouseClicked(0) && !io.WantCaptureMouse))
        state.walking = false;
    if (state.walking)
        io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
    else
        io.ConfigFlags &= ~ImGuiConfigFlags_NavEnableKeyboard;
}

/// ImGui closes popups itself only while the keyboard walks through the panels, and a text field's first
/// Escape restores its text.
void closeTopPopup(const PanelState& state) {
    if (!state.walking && !ImGui::GetIO().WantTextInput)
        ImGui::ClosePopupToLevel(ImGui::GetCurrentContext()->OpenPopupStack.Size - 1, true);
}

/// Escape closes the topmost item.
void escape(const PanelInput& input, PanelState& state) {
    // Help lies over the browser, whose text field has the keyboard.
    if (state.help && ImGui::IsKeyPressed(nativeKey(GLFW_KEY_ESCAPE), false) &&
        !ImGui::IsPopupOpen("", kAnyPopup)) {
        state.help = false;
        return;
    }
    if (!keyPressed(GLFW_KEY_ESCAPE))
        return;
    if (ImGui::IsPopupOpen("", kAnyPopup))
        closeTopPopup(state);
    else if (input.dialog->covers())
        return; // it reads its keys itself
    else if (state.leaving)
        state.leave = PanelState::Leave::Stay;
    else if (input.dialog->stage() == FileDialog::Stage::Desktop)
        input.dialog->close(); // the window's own reads its keys itself
    else if (state.gallery)
        state.gallery = false;
    else if (state.walking)
        state.walking = false;
    else if (input.loading)
        state.cancelPressed = true;
    else if (!input.problem.empty())
        state.dismissPressed = true;
    else
        input.timeline->leave();
}

/// Keys of the prompt for unsaved materials.
void answerKeys(const PanelInput& input, PanelState& state) {
    if (!state.leaving)
        return;
    if (keyPressed({GLFW_KEY_ENTER, GLFW_KEY_KP_ENTER}) && input.canSaveMaterials)
        state.leave = PanelState::Leave::Save;
    if (keyPressed(keyOf('d')))
        state.leave = PanelState::Leave::Discard;
}

/// Clutch and zoom of the hand's workspace. The clutch is held while its key is.
void zoomKeys(PanelState& state) {
    constexpr double kStep = 1.25;
    const ImGuiIO& io = ImGui::GetIO();
    double& zoom = state.workspace.zoom;
    const int clutch = keyOf('c');
    state.workspace.clutch =
        !io.WantTextInput && !io.KeyCtrl && !io.KeyShift && ImGui::IsKeyDown(nativeKey(clutch));
    if (keyPressed(clutch) && io.KeyShift)
        state.centrePressed = true;
    if (keyPressed(GLFW_KEY_PAGE_UP))
        zoom = std::min(zoom * kStep, kMaxZoom);
    if (keyPressed(GLFW_KEY_PAGE_DOWN))
        zoom = std::max(zoom / kStep, kMinZoom);
}

/// Keys that are inactive while a card has the keyboard.
void coveredKeys(const PanelInput& input, PanelState& state) {
    zoomKeys(state);
    sculptKeys(state.sculpt, input.timeline->looking());
    if (keyPressed(keyOf('n')) && input.canSimulate)
        nextStroke(state, ImGui::GetIO().KeyShift ? -1 : 1);
    if (keyPressed(GLFW_KEY_F9))
        state.recordPressed = true;
    if (keyPressed(keyOf('p')))
        state.stopped = state.stopped ? std::nullopt : std::optional(*input.forces);
    if (keyPressed(keyOf('s')))
        state.sound.on = !state.sound.on;
    if (altPressed(keyOf('b')))
        toggleClip(input, state);
    if (keyPressed(keyOf('e')))
        state.editMaterials = !state.editMaterials;
}

/// Ctrl+Shift with plus and minus. On a US keyboard plus is Shift with the key of the equals sign.
void scaleKeys(PanelState& state) {
    if (!ImGui::GetIO().KeyShift)
        return;
    if (ctrlPressed(keyOf('+') == '+' ? keyOf('=') : keyOf('+')) || ctrlPressed(GLFW_KEY_KP_ADD))
        state.uiScale = steppedUiScale(state.uiScale, 1);
    if (ctrlPressed(keyOf('-')) || ctrlPressed(GLFW_KEY_KP_SUBTRACT))
        state.uiScale = steppedUiScale(state.uiScale, -1);
}

void windowKeys(const PanelInput& input, PanelState& state) {
    PanelFolds& folds = state.folds;
    if (keyPressed(GLFW_KEY_F1) || (keyPressed(keyOf('/')) && ImGui::GetIO().KeyShift))
        state.help = !state.help;
    if (keyPressed(GLFW_KEY_F2))
        foldSide(state, &PanelFolds::left, &PanelFolds::right, input);
    if (keyPressed(GLFW_KEY_F3))
        foldSide(state, &PanelFolds::right, &PanelFolds::left, input);
    if (keyPressed(GLFW_KEY_F4))
        folds.bottom = !folds.bottom;
    if (keyPressed(GLFW_KEY_TAB) && !state.walking) {
        const bool all = folds.left && folds.right && folds.bottom;
        folds.left = folds.right = folds.bottom = !all;
    }
    if (keyPressed(GLFW_KEY_F8) && input.canSimulate) {
        state.simulatedHand = !state.simulatedHand || !state.device.empty();
        state.device.clear();
    }
    scaleKeys(state);
    if (ctrlPressed(keyOf('g')))
        state.gallery = !state.gallery;
    if (ctrlPressed(keyOf('o')))
        state.openPressed = true;
    if (ctrlPressed(keyOf('q')))
        state.quitPressed = true;
}

} // namespace

void foldSide(PanelState& state, bool PanelFolds::*side, bool PanelFolds::*other, const PanelInput& input) {
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const auto fitting = [&] { return fittingFolds(state, {display.x, display.y}, input.scale); };
    const bool folded = fitting().*side;
    state.folds.*side = !folded;
    if (folded && fitting().*side)
        state.folds.*other = true;
}

void readPanelKeys(const PanelInput& input, PanelState& state) {
    effectKeys(state);
    escape(input, state);
    answerKeys(input, state);
    windowKeys(input, state);
    if (!state.gallery && !state.leaving && !input.dialog->covers()) {
        coveredKeys(input, state);
        if (!state.walking)
            timelineKeys(*input.timeline);
    } else {
        state.workspace.clutch = false; // its key is not read
        state.sculpt.held = state.sculpt.inverts = state.sculpt.smooths = false;
    }
    walk(state.gallery || input.dialog->covers(), state);
}

} // namespace touchstone

#include "workbench/panels/file_panel.h"

#include "workbench/panels/card.h"
#include "workbench/panels/colors.h"
#include "workbench/screen/native_key.h"

#include <imgui.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

namespace touchstone {

namespace {

// Layout units.
constexpr float kWidth = 760.0f, kHeight = 520.0f, kPlaces = 150.0f, kSize = 80.0f, kButton = 90.0f,
                kMargin = 24.0f;
constexpr size_t kPathBytes = 4096;

std::string sizeText(uint64_t bytes) {
    std::array<char, 32> text{};
    const auto size = static_cast<double>(bytes);
    if (bytes < 1000)
        std::snprintf(text.data(), text.size(), "%.0f B", size);
    else if (bytes < 1'000'000)
        std::snprintf(text.data(), text.size(), "%.1f kB", 1e-3 * size);
    else
        std::snprintf(text.data(), text.size(), "%.1f MB", 1e-6 * size);
    return text.data();
}

/// Also while a text is typed, where they have no other meaning.
bool pressed(int key, bool repeat = false) {
    const ImGuiIO& io = ImGui::GetIO();
    return !io.KeyCtrl && !io.KeyAlt && !io.KeySuper && ImGui::IsKeyPressed(nativeKey(key), repeat);
}

void header(FileDialog& dialog, Widgets& widgets) {
    FileBrowser& browser = dialog.browser();
    ImGui::TextUnformatted(browser.request().saves() ? "Save the model as" : "Open a model or a recording");
    const float close = ImGui::CalcTextSize("x").x + 2.0f * ImGui::GetStyle().FramePadding.x;
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - close);
    if (ImGui::Button("x"))
        dialog.close();
    widgets.mark("fileClose");
    if (!dialog.note().empty())
        ImGui::TextColored(ImColor(kAmber), "%s", dialog.note().c_str());
    const bool top = browser.folder() == browser.folder().parent_path();
    ImGui::BeginDisabled(top);
    if (ImGui::Button("Up"))
        browser.goUp();
    widgets.mark("fileUp");
    ImGui::EndDisabled();
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(browser.folder().c_str());
}

void places(FileBrowser& browser, float height, Widgets& widgets) {
    ImGui::BeginChild("places", ImVec2(widgets.units(kPlaces), height));
    for (const FilePlace& place : browser.request().places) {
        ImGui::PushID(place.folder.c_str());
        const std::filesystem::path folder = place.folder; // a click may change the list
        if (ImGui::Selectable(place.name.c_str(), folder == browser.folder()))
            browser.goTo(folder);
        widgets.mark(("place:" + place.name).c_str(), folder.string());
        ImGui::PopID();
    }
    ImGui::EndChild();
}

/// Why the list is empty or short; empty: no reason to tell.
std::string emptyNoteOf(const FileBrowser& browser) {
    if (browser.reading())
        return "reading ...";
    if (!browser.contents().problem.empty())
        return "This folder cannot be read: " + browser.contents().problem;
    if (browser.shown().empty())
        return "No folder or file here fits.";
    if (!browser.contents().complete)
        return "Only the first " + std::to_string(FolderContents::kMax) +
               " are listed; type a path for others.";
    return {};
}

/// A row; true where it was chosen for good.
bool row(FileBrowser& browser, size_t index, Widgets& widgets) {
    const FolderEntry entry = browser.shown()[index]; // a click may change the list
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    const bool chosen = browser.chosen() == index;
    const std::string label = entry.folder ? entry.name + "/" : entry.name;
    ImGui::PushID(static_cast<int>(index));
    ImGui::PushStyleColor(ImGuiCol_Text, entry.folder ? ImGui::ColorConvertU32ToFloat4(kBlue)
                                                      : ImGui::GetStyleColorVec4(ImGuiCol_Text));
    const bool clicked = ImGui::Selectable(
        label.c_str(), chosen, ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowDoubleClick);
    ImGui::PopStyleColor();
    ImGui::PopID();
    widgets.mark(("file:" + entry.name).c_str());
    ImGui::TableNextColumn();
    if (!entry.folder) {
        const std::string size = sizeText(entry.bytes);
        ImGui::SetCursorPosX(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x -
                             ImGui::CalcTextSize(size.c_str()).x);
        ImGui::TextDisabled("%s", size.c_str());
    }
    if (clicked)
        browser.choose(index);
    return clicked && ImGui::IsMouseDoubleClicked(0);
}

/// True where a row was double-clicked.
bool list(FileBrowser& browser, float height, bool moved, Widgets& widgets) {
    bool opened = false;
    ImGui::BeginChild("list", ImVec2(0.0f, height), true);
    const std::string note = emptyNoteOf(browser);
    if (!note.empty())
        ImGui::TextWrapped("%s", note.c_str());
    if (ImGui::BeginTable("files", 2)) {
        ImGui::TableSetupColumn("name");
        ImGui::TableSetupColumn("size", ImGuiTableColumnFlags_WidthFixed, widgets.units(kSize));
        ImGuiListClipper clipper;
        clipper.Begin(static_cast<int>(browser.shown().size()));
        while (clipper.Step())
            for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
                if (static_cast<size_t>(i) < browser.shown().size())
                    opened = row(browser, static_cast<size_t>(i), widgets) || opened;
        if (moved && browser.chosen()) {
            const float line = ImGui::GetTextLineHeightWithSpacing();
            ImGui::SetScrollY(std::max(0.0f, static_cast<float>(*browser.chosen()) * line - 0.5f * height));
        }
        ImGui::EndTable();
    }
    ImGui::EndChild();
    return opened;
}

/// The text and what is done with it; true where it was entered. `covered`: by a card that has the keyboard.
bool footer(FileDialog& dialog, bool covered, Widgets& widgets) {
    FileBrowser& browser = dialog.browser();
    std::array<char, kPathBytes> text{};
    std::snprintf(text.data(), text.size(), "%s", browser.text().c_str());
    const float beside = widgets.units(kButton) + ImGui::GetStyle().ItemSpacing.x;
    const float kinds =
        browser.request().saves() ? 0.0f : widgets.units(190.0f) + ImGui::GetStyle().ItemSpacing.x;
    // Also after Enter has gone into a folder, or a click was elsewhere, to type on.
    const bool clicked = ImGui::IsMouseReleased(ImGuiMouseButton_Left) && !ImGui::IsAnyItemActive() &&
                         ImGui::IsWindowFocused(ImGuiFocusedFlags_ChildWindows);
    bool& focus = *ImGui::GetStateStorage()->GetBoolRef(ImGui::GetID("focus"), false);
    const bool opened = dialog.takeAsksForFocus() || ImGui::IsWindowAppearing();
    const bool asks = opened || std::exchange(focus, false) || clicked;
    if (asks)
        ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-(beside + kinds));
    const bool entered = ImGui::InputTextWithHint(
        "##path", browser.request().saves() ? "name" : "part of a name, or a path (~ is home)", text.data(),
        text.size(), ImGuiInputTextFlags_EnterReturnsTrue);
    widgets.mark("openPath");
    dialog.setAwaitsText(!covered && !ImGui::IsItemActive() && (asks || entered || dialog.awaitsText()));
    if (browser.text() != text.data())
        browser.setText(text.data());
    if (!browser.request().saves()) {
        ImGui::SameLine();
        ImGui::SetNextItemWidth(widgets.units(190.0f));
        if (ImGui::BeginCombo("##kind", kFileKinds[browser.kind()].name)) {
            for (size_t i = 0; i < kFileKinds.size(); ++i)
                if (ImGui::Selectable(kFileKinds[i].name, i == browser.kind()))
                    browser.setKind(i);
            ImGui::EndCombo();
        }
        widgets.mark("fileKind");
    }
    ImGui::SameLine();
    const bool button =
        ImGui::Button(browser.request().saves() ? "Save" : "Open", ImVec2(widgets.units(kButton), 0.0f));
    widgets.mark("open");
    focus = entered;
    return entered || button;
}

void browserKeys(FileDialog& dialog, bool& moved) {
    FileBrowser& browser = dialog.browser();
    constexpr auto kAny = ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel;
    if (pressed(GLFW_KEY_ESCAPE) && !ImGui::IsPopupOpen("", kAny)) // the list of kinds lies on top
        dialog.close();
    if (ImGui::GetIO().KeyAlt && ImGui::IsKeyPressed(nativeKey(GLFW_KEY_UP), false))
        browser.goUp();
    const int step = (pressed(GLFW_KEY_DOWN, true) ? 1 : 0) - (pressed(GLFW_KEY_UP, true) ? 1 : 0);
    moved = step != 0;
    if (moved)
        browser.moveChoice(step);
}

void drawBrowser(FileDialog& dialog, const WidgetRect& place, bool covered, Widgets& widgets) {
    const float margin = widgets.units(kMargin);
    ImGui::SetNextWindowPos(ImVec2(place.x + 0.5f * place.width, place.y + margin), ImGuiCond_Always,
                            ImVec2(0.5f, 0.0f));
    ImGui::SetNextWindowSize(ImVec2(std::min(widgets.units(kWidth), place.width - 2.0f * margin),
                                    std::min(widgets.units(kHeight), place.height - 2.0f * margin)));
    if (beginCardWindow("file browser", widgets, kAnsweredCard & ~ImGuiWindowFlags_AlwaysAutoResize)) {
        bool moved = false;
        if (!covered)
            browserKeys(dialog, moved);
        header(dialog, widgets);
        const float height = ImGui::GetContentRegionAvail().y - ImGui::GetFrameHeightWithSpacing();
        places(dialog.browser(), height, widgets);
        ImGui::SameLine();
        const bool opened = list(dialog.browser(), height, moved, widgets);
        if ((footer(dialog, covered, widgets) || opened) && dialog.open())
            dialog.enter();
        ImGui::GetIO().WantCaptureKeyboard = true; // the arrows do not move the camera in this frame
    }
    ImGui::End();
}

void drawReplace(FileDialog& dialog, const WidgetRect& picture, bool covered, Widgets& widgets) {
    ImGui::SetNextWindowPos(ImVec2(picture.x + 0.5f * picture.width, picture.y + 0.4f * picture.height),
                            ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    if (beginCardWindow("replace", widgets, kAnsweredCard)) {
        ImGui::Text("%s exists.", dialog.target().filename().c_str());
        ImGui::TextDisabled("%s", dialog.target().parent_path().c_str());
        const bool yes = ImGui::Button("Replace");
        widgets.mark("fileReplace");
        ImGui::SameLine();
        const bool no = ImGui::Button("Another name (Escape)") || (!covered && pressed(GLFW_KEY_ESCAPE));
        widgets.mark("fileKeep");
        if (yes || no)
            dialog.replace(yes);
    }
    ImGui::End();
}

void drawWaiting(FileDialog& dialog, const WidgetRect& picture, Widgets& widgets) {
    ImGui::SetNextWindowPos(ImVec2(picture.x + 0.5f * picture.width, picture.y + widgets.units(kMargin)),
                            ImGuiCond_Always, ImVec2(0.5f, 0.0f));
    if (beginCardWindow("desktop dialog", widgets)) {
        ImGui::TextUnformatted("The desktop's file dialog is open.");
        if (ImGui::Button("Browse here instead"))
            dialog.browse();
        widgets.mark("browseHere");
        ImGui::SameLine();
        if (ImGui::Button("Cancel"))
            dialog.close();
        widgets.mark("dialogCancel");
    }
    ImGui::End();
}

} // namespace

void drawFileDialog(FileDialog& dialog, const WidgetRect& place, const WidgetRect& picture, bool covered,
                    Widgets& widgets) {
    switch (dialog.stage()) {
    case FileDialog::Stage::Closed:
        return;
    case FileDialog::Stage::Desktop:
        return drawWaiting(dialog, picture, widgets);
    case FileDialog::Stage::Browser:
        return drawBrowser(dialog, place, covered, widgets);
    case FileDialog::Stage::Replace:
        return drawReplace(dialog, picture, covered, widgets);
    }
}

} // namespace touchstone

#include "workbench/screen/style.h"

#include <imgui.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <filesystem>

namespace touchstone {

namespace {

constexpr const char* kFont = "/usr/share/fonts/opentype/inter/Inter-Regular.otf"; // Debian's fonts-inter
constexpr float kFontSize = 15.0f, kLargeFontSize = 24.0f;

void applyColors(ImGuiStyle& style) {
    ImGui::StyleColorsDark(&style);
    const auto set = [&](ImGuiCol index, float r, float g, float b, float a = 1.0f) {
        style.Colors[index] = ImVec4(r, g, b, a);
    };
    set(ImGuiCol_WindowBg, 0.105f, 0.113f, 0.125f);
    set(ImGuiCol_PopupBg, 0.125f, 0.133f, 0.148f);
    set(ImGuiCol_Border, 0.20f, 0.21f, 0.23f);
    set(ImGuiCol_Text, 0.90f, 0.91f, 0.92f);
    set(ImGuiCol_TextDisabled, 0.56f, 0.59f, 0.62f);
    set(ImGuiCol_FrameBg, 0.17f, 0.18f, 0.20f);
    set(ImGuiCol_FrameBgHovered, 0.21f, 0.23f, 0.26f);
    set(ImGuiCol_FrameBgActive, 0.24f, 0.27f, 0.31f);
    set(ImGuiCol_Button, 0.19f, 0.21f, 0.24f);
    set(ImGuiCol_ButtonHovered, 0.24f, 0.28f, 0.33f);
    set(ImGuiCol_ButtonActive, 0.20f, 0.42f, 0.70f);
    set(ImGuiCol_CheckMark, 0.38f, 0.68f, 1.0f);
    set(ImGuiCol_SliderGrab, 0.30f, 0.56f, 0.90f);
    set(ImGuiCol_SliderGrabActive, 0.42f, 0.68f, 1.0f);
    set(ImGuiCol_Header, 0.17f, 0.19f, 0.22f);
    set(ImGuiCol_HeaderHovered, 0.21f, 0.24f, 0.28f);
    set(ImGuiCol_HeaderActive, 0.22f, 0.26f, 0.32f);
    set(ImGuiCol_PlotHistogram, 0.30f, 0.56f, 0.90f);
    set(ImGuiCol_Separator, 0.19f, 0.20f, 0.22f);
}

} // namespace

void applyStyle(float scale) {
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr; // no saved ImGui layout
    // With keyboard navigation Enter presses widgets: space always switches the force off.
    io.KeyMap[ImGuiKey_Space] = GLFW_KEY_ENTER;
    io.Fonts->Clear();
    if (std::filesystem::exists(kFont)) {
        static const ImWchar kRanges[] = {0x20, 0xFF, 0x2013, 0x2026, 0x03BC, 0x03BC, 0, 0};
        for (const float size : {kFontSize, kLargeFontSize})
            io.Fonts->AddFontFromFileTTF(kFont, size * scale, nullptr, kRanges);
    } else {
        ImFontConfig config;
        for (const float size : {13.0f, 26.0f}) {
            config.SizePixels = size * scale;
            io.Fonts->AddFontDefault(&config);
        }
    }
    ImGuiStyle& style = ImGui::GetStyle();
    style = ImGuiStyle();
    applyColors(style);
    style.WindowRounding = 0.0f;
    style.WindowBorderSize = 0.0f;
    style.WindowPadding = ImVec2(16.0f, 14.0f);
    style.FrameRounding = 4.0f;
    style.FramePadding = ImVec2(8.0f, 4.0f);
    style.GrabRounding = 4.0f;
    style.PopupRounding = 4.0f;
    style.ItemSpacing = ImVec2(8.0f, 6.0f);
    style.ScaleAllSizes(scale);
}

} // namespace touchstone

#pragma once

#include <imgui.h>

namespace touchstone::test {

/// Dear ImGui without a window, the current context; it reads and writes no file.
class GuiContext {
  public:
    explicit GuiContext(const ImVec2& size) : context_(ImGui::CreateContext()) {
        ImGui::SetCurrentContext(context_);
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = size;
        unsigned char* texels = nullptr;
        int width = 0, height = 0;
        io.Fonts->GetTexDataAsAlpha8(&texels, &width, &height); // makes it; a frame needs one
    }
    ~GuiContext() { ImGui::DestroyContext(context_); }
    GuiContext(const GuiContext&) = delete;
    GuiContext& operator=(const GuiContext&) = delete;

    [[nodiscard]] ImGuiContext* get() const { return context_; }

  private:
    ImGuiContext* context_;
};

} // namespace touchstone::test

#pragma once

#include <imgui.h>

namespace touchstone {

/// GLFW's number of a key for Dear ImGui, which knows it beside its own; the type is an int in 1.86 (Debian
/// 12), and an enumeration in 1.90.
[[nodiscard]] inline ImGuiKey nativeKey(int key) {
    return static_cast<ImGuiKey>(key);
}

} // namespace touchstone

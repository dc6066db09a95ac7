#include "workbench/screen/keys.h"

#include "workbench/screen/native_key.h"

#include <imgui.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace touchstone {

namespace {

constexpr size_t kSigns = 128;
using KeyTable = std::array<int, kSigns>;

/// GLFW names its keys by the US layout.
int americanKey(char sign) {
    return sign >= 'a' && sign <= 'z' ? sign - 'a' + GLFW_KEY_A : static_cast<int>(sign);
}

KeyTable readKeyboard() {
    KeyTable table{};
    for (size_t sign = 0; sign < kSigns; ++sign)
        table[sign] = americanKey(static_cast<char>(sign));
    // From 1.87 on Dear ImGui numbers the keys by what they type, in the names of the US layout.
    constexpr int kFirst = IMGUI_VERSION_NUM < 18700 ? GLFW_KEY_APOSTROPHE : GLFW_KEY_GRAVE_ACCENT + 1;
    for (int key = kFirst; key <= GLFW_KEY_GRAVE_ACCENT; ++key) {
        const char* name = glfwGetKeyName(key, 0);
        const auto sign = name != nullptr ? static_cast<unsigned char>(name[0]) : kSigns;
        if (sign < kSigns && name[1] == '\0')
            table[sign] = key;
    }
    return table;
}

/// Rebuilt every frame: the user may change the layout at any time.
const KeyTable& keyboard() {
    static KeyTable table = readKeyboard();
    static int frame = -1;
    if (ImGui::GetCurrentContext() != nullptr && frame != ImGui::GetFrameCount()) {
        frame = ImGui::GetFrameCount();
        table = readKeyboard();
    }
    return table;
}

bool anyDown(std::initializer_list<int> keys) {
    return std::any_of(keys.begin(), keys.end(), [](int key) { return ImGui::IsKeyDown(nativeKey(key)); });
}

/// Text field shortcuts with Ctrl.
bool editsText(int key) {
    constexpr std::string_view kEditing = "acvxyz";
    return std::any_of(kEditing.begin(), kEditing.end(), [key](char sign) { return keyOf(sign) == key; }) ||
           (key >= GLFW_KEY_ENTER && key <= GLFW_KEY_END);
}

} // namespace

int keyOf(char sign) {
    return keyboard()[static_cast<unsigned char>(sign) % kSigns];
}

bool keyPressed(int key) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool writesNothing = key >= GLFW_KEY_F1 && key <= GLFW_KEY_F25;
    return (!io.WantTextInput || writesNothing) && !io.KeyCtrl && !io.KeyAlt && !io.KeySuper &&
           ImGui::IsKeyPressed(nativeKey(key), false);
}

bool keyPressed(std::initializer_list<int> keys) {
    return std::any_of(keys.begin(), keys.end(), [](int key) { return keyPressed(key); });
}

bool ctrlPressed(int key, bool repeat) {
    const ImGuiIO& io = ImGui::GetIO();
    return !(io.WantTextInput && editsText(key)) && io.KeyCtrl && !io.KeyAlt && !io.KeySuper &&
           ImGui::IsKeyPressed(nativeKey(key), repeat);
}

bool altPressed(int key) {
    const ImGuiIO& io = ImGui::GetIO();
    return !io.WantTextInput && io.KeyAlt && !io.KeyCtrl && !io.KeySuper &&
           ImGui::IsKeyPressed(nativeKey(key), false);
}

double keyAxis(std::initializer_list<int> less, std::initializer_list<int> more) {
    return (anyDown(more) ? 1.0 : 0.0) - (anyDown(less) ? 1.0 : 0.0);
}

} // namespace touchstone

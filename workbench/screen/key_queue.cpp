#include "workbench/screen/key_queue.h"

#include <imgui.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <utility>

namespace touchstone {

namespace {

KeyQueue* installed = nullptr; // GLFW's callbacks have no user data

bool isModifier(int key) {
    return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER;
}

/// True if the key types a character into a text field.
bool writes(int key, int modifiers) {
    return key >= GLFW_KEY_SPACE && key <= GLFW_KEY_WORLD_2 &&
           (modifiers & (GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER)) == 0;
}

} // namespace

KeyQueue::KeyQueue(GLFWwindow* window, std::function<void(int, int)> pressed)
    : window_(window), pressed_(std::move(pressed)) {
    installed = this;
    nextKey_ = glfwSetKeyCallback(window, [](GLFWwindow*, int key, int scancode, int action, int modifiers) {
        if (action == GLFW_REPEAT)
            return; // ImGui itself measures how long a key is held
        if (action == GLFW_PRESS && installed->pressed_)
            installed->pressed_(key, modifiers);
        installed->waiting_.push_back(
            {.key = key, .scancode = scancode, .action = action, .modifiers = modifiers});
    });
    nextCharacter_ = glfwSetCharCallback(window, [](GLFWwindow*, unsigned int codepoint) {
        installed->waiting_.push_back({.character = true, .codepoint = codepoint});
    });
}

KeyQueue::~KeyQueue() {
    glfwSetKeyCallback(window_, nextKey_);
    glfwSetCharCallback(window_, nextCharacter_);
    installed = nullptr;
}

bool KeyQueue::fits(const Event& event, Frame& frame) const {
    const bool text = ImGui::GetIO().WantTextInput;
    if (event.character) {
        frame.wrote = frame.wrote || text;
        return !(text && frame.pressed);
    }
    if (text && writes(event.key, event.modifiers))
        return !frame.pressed;
    if (event.action == GLFW_RELEASE) {
        if (frame.pressed && (event.key == frame.down || isModifier(event.key)))
            return false;
        frame.released.push_back(event.key);
        return true;
    }
    // ImGui polls once per frame: a key released and pressed again in between would count as held.
    const bool cameUp = std::ranges::find(frame.released, event.key) != frame.released.end();
    if (frame.pressed || frame.wrote || cameUp)
        return false;
    if (!isModifier(event.key)) {
        frame.pressed = true;
        frame.down = event.key;
    }
    return true;
}

void KeyQueue::pass(const Event& event) {
    if (event.character) {
        if (nextCharacter_ != nullptr)
            nextCharacter_(window_, event.codepoint);
    } else if (nextKey_ != nullptr) {
        nextKey_(window_, event.key, event.scancode, event.action, event.modifiers);
    }
}

void KeyQueue::feed(bool textAwaited) {
    awaited_ = textAwaited ? awaited_ + 1 : 0;
    const bool holds = textAwaited && awaited_ <= kPatience;
    const auto mayPass = [&](const Event& event) {
        return !holds || (!event.character && event.action == GLFW_RELEASE);
    };
    for (Frame frame; !waiting_.empty() && mayPass(waiting_.front()) && fits(waiting_.front(), frame);
         waiting_.pop_front())
        pass(waiting_.front());
}

} // namespace touchstone

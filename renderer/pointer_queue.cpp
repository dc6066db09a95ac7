#include "renderer/pointer_queue.h"

#include <imgui.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cstddef>
#include <iterator>

namespace touchstone {

namespace {

PointerQueue* installed = nullptr; // GLFW's callbacks have no user data

} // namespace

PointerQueue::PointerQueue(GLFWwindow* window) : window_(window) {
    static_assert(std::size(decltype(ImGuiIO::MouseDown){}) == std::size(decltype(down_){}));
    installed = this;
    nextMove_ = glfwSetCursorPosCallback(window, [](GLFWwindow* handle, double x, double y) {
        installed->waiting_.push_back({.kind = Kind::Move, .value = {x, y}});
        if (installed->nextMove_ != nullptr)
            installed->nextMove_(handle, x, y);
    });
    nextButton_ =
        glfwSetMouseButtonCallback(window, [](GLFWwindow* handle, int button, int action, int modifiers) {
            if (button >= 0 && static_cast<size_t>(button) < installed->down_.size())
                installed->waiting_.push_back(
                    {.kind = Kind::Button, .button = button, .down = action == GLFW_PRESS});
            if (installed->nextButton_ != nullptr)
                installed->nextButton_(handle, button, action, modifiers);
        });
    nextWheel_ = glfwSetScrollCallback(window, [](GLFWwindow*, double x, double y) {
        installed->waiting_.push_back({.kind = Kind::Wheel, .value = {x, y}});
    });
}

PointerQueue::~PointerQueue() {
    glfwSetCursorPosCallback(window_, nextMove_);
    glfwSetMouseButtonCallback(window_, nextButton_);
    glfwSetScrollCallback(window_, nextWheel_);
    installed = nullptr;
}

bool PointerQueue::fits(const Event& event, const Frame& frame) const {
    switch (event.kind) {
    case Kind::Move:
        return !frame.pressed && !frame.turned;
    case Kind::Button:
        return !frame.pressed && (event.down || !frame.moved);
    case Kind::Wheel:
        return !frame.pressed;
    }
    return true;
}

void PointerQueue::take(const Event& event, Frame& frame) {
    switch (event.kind) {
    case Kind::Move:
        place_ = event.value;
        frame.moved = true;
        break;
    case Kind::Button:
        down_[static_cast<size_t>(event.button)] = event.down;
        frame.pressed = true;
        break;
    case Kind::Wheel:
        if (nextWheel_ != nullptr)
            nextWheel_(window_, event.value.x, event.value.y);
        frame.turned = true;
        break;
    }
}

void PointerQueue::feed() {
    ImGuiIO& io = ImGui::GetIO();
    Frame frame;
    for (; !waiting_.empty() && fits(waiting_.front(), frame); waiting_.pop_front())
        take(waiting_.front(), frame);
    if (waiting_.empty() && !frame.pressed && !frame.turned) {
        // As the backend found them: also where GLFW told of no event.
        for (size_t i = 0; i < down_.size(); ++i)
            down_[i] = io.MouseDown[i];
        place_ = {io.MousePos.x, io.MousePos.y};
        return;
    }
    for (size_t i = 0; i < down_.size(); ++i)
        io.MouseDown[i] = down_[i];
    if (ImGui::IsMousePosValid()) // the window has the focus, or the pointer
        io.MousePos = ImVec2(static_cast<float>(place_.x), static_cast<float>(place_.y));
}

} // namespace touchstone

#include "renderer/pointer_queue.h"

#include <imgui.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <iterator>
#include <utility>

namespace touchstone {

namespace {

PointerQueue* installed = nullptr; // GLFW's callbacks have no user data

constexpr double kDoubleClick = 0.3; // s, as ImGui's own

} // namespace

PointerQueue::PointerQueue(GLFWwindow* window) : window_(window), looked_(glfwGetTime()) {
    pressed_.fill(-INFINITY);
    static_assert(std::size(decltype(ImGuiIO::MouseDown){}) == std::size(decltype(down_){}));
    installed = this;
    glfwGetCursorPos(window, &place_.x, &place_.y);
    nextMove_ = glfwSetCursorPosCallback(window, [](GLFWwindow* handle, double x, double y) {
        installed->waiting_.push_back({.move = true, .place = {x, y}});
        if (installed->nextMove_ != nullptr)
            installed->nextMove_(handle, x, y);
    });
    nextButton_ =
        glfwSetMouseButtonCallback(window, [](GLFWwindow* handle, int button, int action, int modifiers) {
            const auto index = static_cast<size_t>(button);
            if (index < installed->down_.size())
                installed->waiting_.push_back({.button = index,
                                               .down = action == GLFW_PRESS,
                                               .after = installed->looked_,
                                               .before = glfwGetTime()});
            if (installed->nextButton_ != nullptr)
                installed->nextButton_(handle, button, action, modifiers);
        });
}

PointerQueue::~PointerQueue() {
    glfwSetCursorPosCallback(window_, nextMove_);
    glfwSetMouseButtonCallback(window_, nextButton_);
    installed = nullptr;
}

void PointerQueue::feed() {
    ImGuiIO& io = ImGui::GetIO();
    bool changed = false;
    for (; !waiting_.empty() && !changed; waiting_.pop_front()) {
        const Event& event = waiting_.front();
        changed = !event.move;
        if (event.move) {
            place_ = event.place;
            continue;
        }
        down_[event.button] = event.down;
        if (event.down) {
            const double apart =
                event.after - std::exchange(pressed_[event.button], event.before); // at least
            io.MouseDoubleClickTime = apart < kDoubleClick ? FLT_MAX : 0.0f;
        }
    }
    looked_ = glfwGetTime();
    if (changed || !waiting_.empty()) {
        std::ranges::copy(down_, io.MouseDown);
        io.MousePos = ImVec2(static_cast<float>(place_.x), static_cast<float>(place_.y));
    } else { // as the backend found them: the newest, also where GLFW told of no event
        std::ranges::copy(io.MouseDown, down_.begin());
    }
}

} // namespace touchstone

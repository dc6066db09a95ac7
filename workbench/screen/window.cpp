#include "workbench/screen/window.h"

#include "engine/core/error.h"
#include "workbench/figures/ui_scale.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <string>
#include <utility>

namespace touchstone {

namespace {

[[noreturn]] void failWith(const char* what) {
    const char* reason = nullptr;
    glfwGetError(&reason);
    std::string problem = what;
    if (reason != nullptr)
        problem += std::string(": ") + reason;
    throw Error("window", "", problem,
                "start it from a desktop session (DISPLAY is set there), or run without a window: "
                "touchstone run SCENE --seconds 10 --screenshot shot.png");
}

/// Width and height over all monitors, screen coordinates; the largest window where there is none.
glm::ivec2 desktopExtent() {
    constexpr int kLargest = 16384;
    int count = 0;
    GLFWmonitor** monitors = glfwGetMonitors(&count);
    glm::ivec2 low(kLargest), high(-kLargest);
    for (int i = 0; i < count; ++i) {
        const GLFWvidmode* mode = glfwGetVideoMode(monitors[i]);
        if (mode == nullptr)
            continue;
        glm::ivec2 corner(0);
        glfwGetMonitorPos(monitors[i], &corner.x, &corner.y);
        low = glm::min(low, corner);
        high = glm::max(high, corner + glm::ivec2(mode->width, mode->height));
    }
    return high.x > low.x && high.y > low.y ? high - low : glm::ivec2(kLargest);
}

std::string sizeText(const glm::ivec2& size) {
    return std::to_string(size.x) + "x" + std::to_string(size.y);
}

} // namespace

Window::Window(const char* title, const glm::ivec2& asked) {
    if (glfwInit() != GLFW_TRUE)
        failWith("no display can be reached");
    const glm::ivec2 least(kMinLayout), size = glm::clamp(asked, least, glm::max(least, desktopExtent()));
    if (size != asked)
        sizeWarning_ = "a window of " + sizeText(asked) + " does not fit this desktop: it is opened as " +
                       sizeText(size);
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    window_ = glfwCreateWindow(size.x, size.y, title, nullptr, nullptr);
    if (window_ == nullptr) {
        // glfwTerminate would clear the reason.
        try {
            failWith("the window could not be opened");
        } catch (...) {
            glfwTerminate();
            throw;
        }
    }
    glfwSetWindowUserPointer(window_, this);
    glfwSetDropCallback(window_, [](GLFWwindow* handle, int count, const char** paths) {
        if (count > 0)
            static_cast<Window*>(glfwGetWindowUserPointer(handle))->dropped_ = paths[0];
    });
    glfwSetWindowSizeLimits(window_, least.x, least.y, GLFW_DONT_CARE, GLFW_DONT_CARE);
}

Window::~Window() {
    glfwDestroyWindow(window_);
    glfwTerminate();
}

bool Window::shouldClose() const {
    return glfwWindowShouldClose(window_) == GLFW_TRUE;
}

void Window::waitEvents(double seconds) {
    if (seconds > 0.0)
        glfwWaitEventsTimeout(seconds);
    else
        glfwPollEvents();
}

float Window::layoutScale() const {
    float x = 1.0f, y = 1.0f;
    glfwGetWindowContentScale(window_, &x, &y);
    int width = 0, pixels = 0, ignored = 0;
    glfwGetWindowSize(window_, &width, &ignored);
    glfwGetFramebufferSize(window_, &pixels, &ignored);
    const float alreadyScaled =
        width > 0 && pixels > 0 ? static_cast<float>(pixels) / static_cast<float>(width) : 1.0f;
    return std::max(1.0f, std::max(x, y) / alreadyScaled);
}

std::optional<std::filesystem::path> Window::takeDropped() {
    return std::exchange(dropped_, std::nullopt);
}

glm::ivec2 Window::size() const {
    glm::ivec2 size(0);
    glfwGetWindowSize(window_, &size.x, &size.y);
    return size;
}

void Window::stayOpen() {
    glfwSetWindowShouldClose(window_, GLFW_FALSE);
}

void Window::close() {
    glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

void Window::setTitle(const std::string& title) {
    glfwSetWindowTitle(window_, title.c_str());
}

} // namespace touchstone

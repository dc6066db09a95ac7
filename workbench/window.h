#pragma once

#include <glm/glm.hpp>

#include <filesystem>
#include <optional>

struct GLFWwindow;

namespace touchstone {

/// The window and GLFW's lifetime. Main thread only.
class Window {
  public:
    /// Throws Error where no display can be reached.
    Window(const char* title, const glm::ivec2& size);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    [[nodiscard]] GLFWwindow* handle() const { return window_; }
    [[nodiscard]] bool shouldClose() const;
    /// Handles what happened; waits up to `seconds` for something to happen.
    void waitEvents(double seconds);
    /// Pixels for one screen unit of the desktop's scaling: 1 on plain screens, 2 on dense ones.
    [[nodiscard]] float contentScale() const;
    /// The file that was dropped on the window since the last call.
    [[nodiscard]] std::optional<std::filesystem::path> takeDropped();
    void setTitle(const std::string& title);

  private:
    GLFWwindow* window_ = nullptr;
    std::optional<std::filesystem::path> dropped_;
};

} // namespace touchstone

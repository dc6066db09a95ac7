#pragma once

#include <glm/glm.hpp>

#include <filesystem>
#include <optional>
#include <string>

struct GLFWwindow;

namespace touchstone {

/// The window and GLFW's lifetime. Main thread only.
class Window {
  public:
    /// `size` in screen coordinates, cut to what a window may have: kMinLayout at least, the monitors' extent
    /// at most. Throws Error where no display can be reached.
    Window(const char* title, const glm::ivec2& size);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    [[nodiscard]] GLFWwindow* handle() const { return window_; }
    [[nodiscard]] bool shouldClose() const;
    /// Handles pending events; waits up to `seconds` for one.
    void waitEvents(double seconds);
    /// Window coordinates per layout unit: 1 on plain screens, 2 on dense ones whose coordinates are pixels
    /// (X11), 1 where the desktop scales the coordinates itself (Wayland).
    [[nodiscard]] float layoutScale() const;
    /// The file dropped on the window since the last call.
    [[nodiscard]] std::optional<std::filesystem::path> takeDropped();
    [[nodiscard]] glm::ivec2 size() const; ///< screen coordinates
    /// What is wrong with the size given to the constructor; empty: nothing.
    [[nodiscard]] const std::string& sizeWarning() const { return sizeWarning_; }
    void stayOpen(); ///< revokes shouldClose
    void close();    ///< sets shouldClose
    void setTitle(const std::string& title);

  private:
    GLFWwindow* window_ = nullptr;
    std::optional<std::filesystem::path> dropped_;
    std::string sizeWarning_;
};

} // namespace touchstone

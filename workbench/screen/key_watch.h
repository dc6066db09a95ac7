#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

struct GLFWwindow;

namespace touchstone {

/// Watches one key of a window on its own thread and X connection, independently of rendering: the key is
/// seen while the main thread is blocked, and whatever widget has the focus. (X delivers a key to every
/// client that selects it on the window.)
///
/// On Wayland a second connection receives no keys of the window: there `alive` is false.
class KeyWatch {
  public:
    /// Main thread. `pressed` is called on the watch thread on a press, not on its repetitions; `plain`:
    /// without Ctrl, Alt and Super.
    KeyWatch(GLFWwindow* window, int glfwKey, std::function<void(bool plain)> pressed);
    ~KeyWatch();
    KeyWatch(const KeyWatch&) = delete;
    KeyWatch& operator=(const KeyWatch&) = delete;

    /// Any thread: false without an X server or after a lost connection.
    [[nodiscard]] bool alive() const { return alive_.load(std::memory_order_acquire); }
    /// Number of presses; nullopt while not alive. Any thread.
    [[nodiscard]] std::optional<uint32_t> presses() const {
        return alive() ? std::optional(presses_.load(std::memory_order_acquire)) : std::nullopt;
    }

  private:
    struct Connection;
    void watch();

    std::function<void(bool)> pressed_;
    std::unique_ptr<Connection> connection_;
    std::atomic<bool> alive_{false};
    std::atomic<uint32_t> presses_{0};
    std::thread thread_;
};

} // namespace touchstone

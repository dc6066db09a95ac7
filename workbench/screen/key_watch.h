#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

struct GLFWwindow;

namespace touchstone {

/// Watches one key of a window on a thread and a connection to the X server of its own, which neither draw
/// nor wait for what draws: the key is seen while the main thread stands still, and whatever widget has the
/// focus. (X delivers a key to every client that selects it on the window.)
///
/// On Wayland a second connection sees no keys of the window: there `alive` is false.
class KeyWatch {
  public:
    /// Main thread. `pressed` is called on the thread of the watch when the key goes down, not when it is
    /// repeated; `plain`: without Ctrl, Alt and Super.
    KeyWatch(GLFWwindow* window, int glfwKey, std::function<void(bool plain)> pressed);
    ~KeyWatch();
    KeyWatch(const KeyWatch&) = delete;
    KeyWatch& operator=(const KeyWatch&) = delete;

    /// Any thread: false where there is no X server or the connection is lost.
    [[nodiscard]] bool alive() const { return alive_.load(std::memory_order_acquire); }
    /// How often the key went down; nothing while not alive. Any thread.
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

#pragma once

#include <deque>
#include <functional>
#include <vector>

struct GLFWwindow;

namespace touchstone {

/// Keys and characters between GLFW and Dear ImGui, which looks at the keys once a frame only and would not
/// see one that is down for less. They wait here in their order, and a frame takes as many as it can tell
/// apart: up to the second key that goes down, and not the release of the one that did. What writes into a
/// text field is taken at once, but not past an editing key. Main thread.
class KeyQueue {
  public:
    /// `pressed` is called when the event is handled, before the frame that takes it. After the callbacks of
    /// ImGui's backend are installed, whose place it takes. One at a time.
    KeyQueue(GLFWwindow* window, std::function<void(int key, int modifiers)> pressed);
    ~KeyQueue();
    KeyQueue(const KeyQueue&) = delete;
    KeyQueue& operator=(const KeyQueue&) = delete;

    /// Before each ImGui frame.
    void feed();

  private:
    struct Event {
        bool character = false;
        int key = 0, scancode = 0, action = 0, modifiers = 0;
        unsigned int codepoint = 0;
    };
    struct Frame {
        int down = 0; ///< the key that went down in it
        bool pressed = false, wrote = false;
        std::vector<int> released; ///< keys that came up in it
    };
    [[nodiscard]] bool fits(const Event& event, Frame& frame) const;
    void pass(const Event& event);

    GLFWwindow* window_;
    std::function<void(int, int)> pressed_;
    std::deque<Event> waiting_;
    void (*nextKey_)(GLFWwindow*, int, int, int, int) = nullptr;
    void (*nextCharacter_)(GLFWwindow*, unsigned int) = nullptr;
};

} // namespace touchstone

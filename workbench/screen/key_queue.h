#pragma once

#include <deque>
#include <functional>
#include <vector>

struct GLFWwindow;

namespace touchstone {

/// Queues keys and characters between GLFW and Dear ImGui, which polls the keys once per frame and would miss
/// a shorter press. Events wait in order; a frame takes as many as it can distinguish: up to the second key
/// press, and not the release of the first. Characters for a text field are passed on at once, but not past
/// an editing key. Main thread.
class KeyQueue {
  public:
    /// `pressed` is called when the event is handled, before the frame that takes it. Construct after the
    /// callbacks of ImGui's backend are installed, which it replaces. One at a time.
    KeyQueue(GLFWwindow* window, std::function<void(int key, int modifiers)> pressed);
    ~KeyQueue();
    KeyQueue(const KeyQueue&) = delete;
    KeyQueue& operator=(const KeyQueue&) = delete;

    /// Before each ImGui frame. `textAwaited`: a text field is to have the keyboard and does not have it yet,
    /// which takes Dear ImGui some frames: presses and characters wait for it, for kPatience frames.
    void feed(bool textAwaited = false);

  private:
    static constexpr int kPatience = 10; // frames
    struct Event {
        bool character = false;
        int key = 0, scancode = 0, action = 0, modifiers = 0;
        unsigned int codepoint = 0;
    };
    struct Frame {
        int down = 0; ///< the key that was pressed in it
        bool pressed = false, wrote = false;
        std::vector<int> released; ///< keys that were released in it
    };
    [[nodiscard]] bool fits(const Event& event, Frame& frame) const;
    void pass(const Event& event);

    GLFWwindow* window_;
    std::function<void(int, int)> pressed_;
    std::deque<Event> waiting_;
    int awaited_ = 0; // frames for which a text field has been awaited
    void (*nextKey_)(GLFWwindow*, int, int, int, int) = nullptr;
    void (*nextCharacter_)(GLFWwindow*, unsigned int) = nullptr;
};

} // namespace touchstone

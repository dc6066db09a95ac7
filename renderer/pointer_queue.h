#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <cstddef>
#include <deque>

struct GLFWwindow;

namespace touchstone {

/// Queues the pointer's events between GLFW and Dear ImGui before 1.87, which reads place and buttons once
/// per frame: in a frame that takes a tenth of a second a press would count where the pointer has gone since,
/// and a drag would end before its last move. Events wait in order; a frame takes moves up to the next button
/// or turn of the wheel, one button, and no release after a move. Main thread.
class PointerQueue {
  public:
    /// After the callbacks of ImGui's backend are installed, which it replaces. One at a time.
    explicit PointerQueue(GLFWwindow* window);
    ~PointerQueue();
    PointerQueue(const PointerQueue&) = delete;
    PointerQueue& operator=(const PointerQueue&) = delete;

    /// Between the backend's NewFrame, which has set place and buttons as they are now, and ImGui's.
    void feed();

  private:
    enum class Kind { Move, Button, Wheel };
    struct Event {
        Kind kind = Kind::Move;
        glm::dvec2 value{0.0}; ///< place in the window, or turn of the wheel
        int button = 0;
        bool down = false;
    };
    struct Frame {
        bool moved = false, pressed = false, turned = false;
    };
    [[nodiscard]] bool fits(const Event& event, const Frame& frame) const;
    void take(const Event& event, Frame& frame);

    GLFWwindow* window_;
    std::deque<Event> waiting_;
    glm::dvec2 place_{0.0};
    std::array<bool, 5> down_{}; ///< ImGui's buttons
    void (*nextMove_)(GLFWwindow*, double, double) = nullptr;
    void (*nextButton_)(GLFWwindow*, int, int, int) = nullptr;
    void (*nextWheel_)(GLFWwindow*, double, double) = nullptr;
};

} // namespace touchstone

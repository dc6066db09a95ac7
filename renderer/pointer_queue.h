#pragma once

#include <glm/vec2.hpp>

#include <array>
#include <cstddef>
#include <deque>

struct GLFWwindow;

namespace touchstone {

/// Queues the pointer's moves and buttons between GLFW and Dear ImGui before 1.87, which reads place and
/// buttons once per frame: in a frame that takes a tenth of a second a press would count where the pointer
/// has gone since. Events wait in order; a frame takes moves up to a button, and one button. (ImGui 1.87 has
/// such a queue.) ImGui takes two clicks for one double click by the times of the frames that took them, of
/// which a double click needs three: here it is the time between the clicks. Main thread.
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
    struct Event {
        bool move = false;
        glm::dvec2 place{0.0}; ///< in the window, of a move
        size_t button = 0;     ///< otherwise
        bool down = false;
        double after = 0.0, before = 0.0; ///< s: it came between two looks for events
    };

    GLFWwindow* window_;
    std::deque<Event> waiting_;
    glm::dvec2 place_{0.0};         ///< of the last move that was taken
    std::array<bool, 5> down_{};    ///< ImGui's buttons
    std::array<double, 5> pressed_; ///< s: last press of each, at the latest
    double looked_;                 ///< s: the last look for events
    void (*nextMove_)(GLFWwindow*, double, double) = nullptr;
    void (*nextButton_)(GLFWwindow*, int, int, int) = nullptr;
};

} // namespace touchstone

#include "workbench/screen/key_watch.h"

#include "devices/link/linked_device.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>
#include <xcb/xcb.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <system_error>
#include <utility>

// Not in every libglfw: the Wayland build has the same soname without this function.
extern "C" __attribute__((weak)) unsigned long glfwGetX11Window(GLFWwindow* window);

namespace touchstone {

namespace {

using Event = std::unique_ptr<xcb_generic_event_t, decltype(&std::free)>;

constexpr uint8_t kEventType = 0x7f; // the top bit marks events sent by another client
constexpr uint16_t kNotPlain = XCB_MOD_MASK_CONTROL | XCB_MOD_MASK_1 | XCB_MOD_MASK_4;

} // namespace

/// XCB and not Xlib: no process-wide error handler, and a lost connection does not end the process.
struct KeyWatch::Connection {
    xcb_connection_t* server = nullptr;
    xcb_window_t window = 0;
    xcb_keycode_t key = 0;
    int stop = -1; // an eventfd
    bool down = false;
    std::optional<xcb_timestamp_t> released; // time of the last release

    ~Connection() {
        if (server != nullptr)
            xcb_disconnect(server);
        if (stop >= 0)
            close(stop);
    }

    [[nodiscard]] bool open() {
        stop = eventfd(0, EFD_CLOEXEC);
        server = xcb_connect(nullptr, nullptr);
        if (stop < 0 || xcb_connection_has_error(server) != 0)
            return false;
        const uint32_t events =
            XCB_EVENT_MASK_KEY_PRESS | XCB_EVENT_MASK_KEY_RELEASE | XCB_EVENT_MASK_STRUCTURE_NOTIFY;
        const std::unique_ptr<xcb_generic_error_t, decltype(&std::free)> refused(
            xcb_request_check(
                server, xcb_change_window_attributes_checked(server, window, XCB_CW_EVENT_MASK, &events)),
            &std::free);
        return refused == nullptr;
    }

    /// Waits for an event; false where the watch is to end.
    [[nodiscard]] bool wait() const {
        std::array<pollfd, 2> files{{{xcb_get_file_descriptor(server), POLLIN, 0}, {stop, POLLIN, 0}}};
        const int ready = poll(files.data(), files.size(), -1);
        return (ready >= 0 || errno == EINTR) && files[1].revents == 0;
    }

    /// Whether the key was pressed. The server repeats a held key as a release and a press of the same time.
    /// A release of a released key means nothing: xdotool sends one before each press, often in the same
    /// millisecond.
    [[nodiscard]] bool isPress(const xcb_generic_event_t& event) {
        const auto& input = reinterpret_cast<const xcb_key_press_event_t&>(event);
        const auto type = event.response_type & kEventType;
        if ((type != XCB_KEY_PRESS && type != XCB_KEY_RELEASE) || input.detail != key)
            return false;
        const bool pressed = type == XCB_KEY_PRESS, repeated = pressed && released == input.time;
        released = !pressed && down ? std::optional(input.time) : std::nullopt;
        down = pressed;
        return pressed && !repeated;
    }
};

KeyWatch::KeyWatch(GLFWwindow* window, int glfwKey, std::function<void(bool)> pressed)
    : pressed_(std::move(pressed)) {
    if (glfwGetX11Window == nullptr)
        return;
    auto connection = std::make_unique<Connection>();
    connection->window = static_cast<xcb_window_t>(glfwGetX11Window(window));
    const int code = glfwGetKeyScancode(glfwKey); // a keycode, on X
    if (connection->window == 0 || code <= 0 || code > 255)
        return;
    connection->key = static_cast<xcb_keycode_t>(code);
    if (!connection->open())
        return;
    connection_ = std::move(connection);
    alive_ = true;
    try {
        thread_ = std::thread([this] { watch(); });
    } catch (const std::system_error&) { // no thread: the window's own events remain
        alive_ = false;
        connection_.reset();
    }
}

KeyWatch::~KeyWatch() {
    if (!thread_.joinable())
        return;
    const uint64_t one = 1;
    (void)!write(connection_->stop, &one, sizeof one);
    thread_.join();
}

void KeyWatch::watch() {
    (void)enterIoPriority();
    Connection& connection = *connection_;
    bool goesOn = true;
    while (goesOn) {
        while (const Event event{xcb_poll_for_event(connection.server), &std::free}) {
            const auto type = event->response_type & kEventType;
            if (connection.isPress(*event)) {
                pressed_((reinterpret_cast<const xcb_key_press_event_t&>(*event).state & kNotPlain) == 0);
                presses_.fetch_add(1, std::memory_order_release);
            }
            goesOn = goesOn && type != XCB_DESTROY_NOTIFY;
        }
        goesOn = goesOn && xcb_connection_has_error(connection.server) == 0 && connection.wait();
    }
    alive_.store(false, std::memory_order_release);
}

} // namespace touchstone

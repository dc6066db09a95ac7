// drop_file WINDOW FILE: drops a file on an X window as a file manager does (XDND, version 5), and waits
// until it has been taken. Status 0: it was.

#include <X11/Xatom.h>
#include <X11/Xlib.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

namespace {

class DropSource {
  public:
    DropSource(Display* display, Window target, std::string file)
        : display_(display), target_(target), uri_("file://" + std::move(file) + "\r\n"),
          source_(XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0)) {
        XSetSelectionOwner(display_, atom("XdndSelection"), source_, CurrentTime);
        XWindowAttributes size;
        XGetWindowAttributes(display_, target_, &size);
        Window child = 0;
        XTranslateCoordinates(display_, target_, DefaultRootWindow(display_), size.width / 2, size.height / 2,
                              &x_, &y_, &child);
    }

    /// The whole conversation; false where the window does not want it or does not answer in time.
    bool drop() {
        constexpr long kVersion = 5;
        send("XdndEnter", kVersion << 24, static_cast<long>(atom("text/uri-list")), 0, 0);
        send("XdndPosition", 0, (static_cast<long>(x_) << 16) | y_, CurrentTime,
             static_cast<long>(atom("XdndActionCopy")));
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (std::chrono::steady_clock::now() < end) {
            if (XPending(display_) == 0) {
                std::this_thread::sleep_for(std::chrono::milliseconds(10));
                continue;
            }
            XEvent event;
            XNextEvent(display_, &event);
            if (event.type == SelectionRequest)
                hand(event.xselectionrequest);
            if (event.type != ClientMessage)
                continue;
            // GLFW 3.3 finishes with the number of bytes that it got where others set bit 0.
            if (event.xclient.message_type == atom("XdndFinished"))
                return event.xclient.data.l[1] != 0;
            if (event.xclient.message_type == atom("XdndStatus")) {
                if ((event.xclient.data.l[1] & 1) == 0)
                    return false;
                send("XdndDrop", 0, CurrentTime, 0, 0);
            }
        }
        return false;
    }

  private:
    Atom atom(const char* name) { return XInternAtom(display_, name, False); }

    void send(const char* message, long a, long b, long c, long d) {
        XEvent event{};
        event.xclient.type = ClientMessage;
        event.xclient.window = target_;
        event.xclient.message_type = atom(message);
        event.xclient.format = 32;
        event.xclient.data.l[0] = static_cast<long>(source_);
        event.xclient.data.l[1] = a;
        event.xclient.data.l[2] = b;
        event.xclient.data.l[3] = c;
        event.xclient.data.l[4] = d;
        XSendEvent(display_, target_, False, NoEventMask, &event);
        XFlush(display_);
    }

    /// Gives the name of the file to whom it was dropped on.
    void hand(const XSelectionRequestEvent& request) {
        XChangeProperty(display_, request.requestor, request.property, request.target, 8, PropModeReplace,
                        reinterpret_cast<const unsigned char*>(uri_.data()), static_cast<int>(uri_.size()));
        XEvent event{};
        event.xselection.type = SelectionNotify;
        event.xselection.requestor = request.requestor;
        event.xselection.selection = request.selection;
        event.xselection.target = request.target;
        event.xselection.property = request.property;
        event.xselection.time = request.time;
        XSendEvent(display_, request.requestor, False, NoEventMask, &event);
        XFlush(display_);
    }

    Display* display_;
    Window target_;
    std::string uri_;
    Window source_;
    int x_ = 0, y_ = 0; // of the target's middle on the screen
};

} // namespace

int main(int count, char** arguments) {
    if (count != 3)
        return 2;
    Display* display = XOpenDisplay(nullptr);
    if (display == nullptr)
        return 2;
    const bool taken = DropSource(display, std::strtoul(arguments[1], nullptr, 0), arguments[2]).drop();
    XCloseDisplay(display);
    return taken ? 0 : 1;
}

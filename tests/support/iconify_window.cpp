// iconify_window WINDOW on|off: minimises an X window, or brings it back, as a window manager does
// (ICCCM 4.1.4): its property WM_STATE says so, and it is unmapped or mapped.

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

int main(int argc, char** argv) {
    Display* display = XOpenDisplay(nullptr);
    if (argc != 3 || display == nullptr) {
        std::fprintf(stderr, "usage: iconify_window WINDOW on|off, with DISPLAY set\n");
        return 2;
    }
    const Window window = std::strtoul(argv[1], nullptr, 0);
    const bool iconic = std::strcmp(argv[2], "on") == 0;
    const Atom state = XInternAtom(display, "WM_STATE", False);
    const long content[2]{iconic ? IconicState : NormalState, None};
    XChangeProperty(display, window, state, state, 32, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(content), 2);
    if (iconic)
        XUnmapWindow(display, window);
    else
        XMapWindow(display, window);
    XSync(display, False);
    XCloseDisplay(display);
    return 0;
}

// tap_key HOLD_MS GAP_MS COUNT KEY [KEY ...]: taps the keys in turn, COUNT times all of them, on the X server
// of DISPLAY, by XTEST as if on the keyboard. A key may have modifiers: ctrl+q. Prints for each that went
// down when it was sent and when the server had taken it, CLOCK_MONOTONIC in ns.

#include <X11/Xlib.h>
#include <X11/extensions/XTest.h>
#include <X11/keysym.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

long long now() {
    return std::chrono::nanoseconds(Clock::now().time_since_epoch()).count();
}

std::vector<KeyCode> codesOf(Display* display, const std::string& chord) {
    std::vector<KeyCode> codes;
    for (size_t begin = 0; begin <= chord.size();) {
        const size_t end = std::min(chord.find('+', begin), chord.size());
        std::string name = chord.substr(begin, end - begin);
        if (name == "ctrl")
            name = "Control_L";
        if (name == "shift")
            name = "Shift_L";
        const KeyCode code = XKeysymToKeycode(display, XStringToKeysym(name.c_str()));
        if (code == 0) {
            std::fprintf(stderr, "tap_key: no key writes %s\n", name.c_str());
            std::exit(1);
        }
        codes.push_back(code);
        begin = end + 1;
    }
    return codes;
}

} // namespace

int main(int argc, char** argv) {
    Display* display = argc > 4 ? XOpenDisplay(nullptr) : nullptr;
    if (display == nullptr)
        return 1;
    const auto milliseconds = [&](int argument) {
        return std::chrono::milliseconds(std::atoi(argv[argument]));
    };
    const auto hold = milliseconds(1), gap = milliseconds(2);
    for (int count = std::atoi(argv[3]); count > 0; --count)
        for (int i = 4; i < argc; ++i) {
            const std::vector<KeyCode> codes = codesOf(display, argv[i]);
            const long long sent = now();
            for (const KeyCode code : codes)
                XTestFakeKeyEvent(display, code, True, CurrentTime);
            XSync(display, False);
            std::printf("%lld %lld\n", sent, now());
            std::this_thread::sleep_for(hold);
            for (auto code = codes.rbegin(); code != codes.rend(); ++code)
                XTestFakeKeyEvent(display, *code, False, CurrentTime);
            XSync(display, False);
            std::this_thread::sleep_for(gap);
        }
    XCloseDisplay(display);
    return 0;
}

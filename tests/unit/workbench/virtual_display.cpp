#include "tests/unit/workbench/virtual_display.h"

#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace touchstone::test {

namespace {

// A frame and more lies between two events, in s as xdotool's sleep takes it. Where frames take longer,
// PointerQueue and KeyQueue keep events in their order, and give a frame those that it can tell apart.
constexpr const char* kFrame = "0.04";

void pause(int milliseconds) {
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

} // namespace

VirtualDisplay::VirtualDisplay(int width, int height) {
    // -noreset: else the server starts anew whenever its last client leaves, and refuses newcomers meanwhile.
    // Xvfb finds a free number itself and writes it to the file behind the descriptor.
    const std::string number = (scratch_ / "display").string();
    const std::string screen = std::to_string(width) + "x" + std::to_string(height) + "x24";
    server_ = std::make_unique<BackgroundProgram>(
        std::vector<std::string>{"sh", "-c",
                                 "exec Xvfb -displayfd 3 -noreset -nolisten tcp -screen 0 " + screen +
                                     " -fbdir " + scratch_.path().string() + " 3>" + number},
        Environment{}, scratch_ / "xvfb.log");
    for (int i = 0; i < 1200 && server_->running(); ++i) {
        const std::string answer = readFile(number);
        if (!answer.empty() && answer.back() == '\n') {
            name_ = ":" + answer.substr(0, answer.size() - 1);
            return;
        }
        pause(50);
    }
    throw std::runtime_error("Xvfb does not start: " + readFile(scratch_ / "xvfb.log"));
}

ScreenPicture VirtualDisplay::screen() const {
    // The X window dump that Xvfb keeps in a file: a header of big-endian words, a colour map of 12 bytes an
    // entry, rows of 32-bit pixels in the machine's order.
    const std::string dump = readFile(scratch_ / "Xvfb_screen0");
    const auto word = [&](size_t index) {
        uint32_t value = 0;
        for (size_t i = 4 * index; i < 4 * index + 4; ++i)
            value = value << 8 | static_cast<uint8_t>(dump.at(i));
        return static_cast<size_t>(value);
    };
    constexpr size_t kWidth = 4, kHeight = 5, kBitsPerPixel = 11, kBytesPerLine = 12, kColours = 19;
    if (dump.size() < 100 || word(kBitsPerPixel) != 32)
        throw std::runtime_error("Xvfb shows no screen of 32 bits a pixel");
    ScreenPicture picture{static_cast<int>(word(kWidth)), static_cast<int>(word(kHeight)), {}};
    const size_t begin = word(0) + 12 * word(kColours);
    for (size_t y = 0; y < word(kHeight); ++y)
        for (size_t x = 0; x < word(kWidth); ++x) {
            const size_t at = begin + y * word(kBytesPerLine) + 4 * x;
            picture.pixels.push_back({static_cast<uint8_t>(dump.at(at + 2)),
                                      static_cast<uint8_t>(dump.at(at + 1)),
                                      static_cast<uint8_t>(dump.at(at))});
        }
    return picture;
}

std::string VirtualDisplay::xdotool(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "xdotool");
    const ProgramResult result = runProgram(arguments, environment());
    if (result.status != 0)
        throw std::runtime_error("xdotool failed: " + result.err);
    return result.out;
}

VirtualDisplay::Place VirtualDisplay::waitForWindow(const std::string& title) const {
    for (int i = 0; i < 300; ++i) {
        const ProgramResult found =
            runProgram({"xdotool", "search", "--onlyvisible", "--name", title}, environment());
        if (found.status == 0 && !found.out.empty()) {
            const std::string window = found.out.substr(0, found.out.find('\n'));
            std::istringstream geometry(xdotool({"getwindowgeometry", "--shell", window}));
            Place place;
            for (std::string line; std::getline(geometry, line);) {
                if (line.starts_with("X="))
                    place.x = std::atoi(line.c_str() + 2);
                if (line.starts_with("Y="))
                    place.y = std::atoi(line.c_str() + 2);
            }
            // Without a window manager nobody gives the keyboard to the window.
            xdotool({"windowfocus", window});
            return place;
        }
        pause(100);
    }
    throw std::runtime_error("no window called " + title);
}

// What follows must not come before the pointer: each action ends with the pause.

void VirtualDisplay::move(const Place& place) const {
    xdotool({"mousemove", std::to_string(place.x), std::to_string(place.y), "sleep", kFrame});
}

void VirtualDisplay::press(int button) const {
    xdotool({"mousedown", std::to_string(button), "sleep", kFrame});
}

void VirtualDisplay::release(int button) const {
    xdotool({"mouseup", std::to_string(button), "sleep", kFrame});
}

void VirtualDisplay::click(const Place& place, int button) const {
    xdotool({"mousemove", std::to_string(place.x), std::to_string(place.y), "sleep", kFrame, "mousedown",
             std::to_string(button), "sleep", kFrame, "mouseup", std::to_string(button), "sleep", kFrame});
}

void VirtualDisplay::drag(const Place& from, const Place& to, int button) const {
    constexpr int kSteps = 12;
    move(from);
    std::vector<std::string> words{"mousedown", std::to_string(button), "sleep", kFrame};
    for (int i = 1; i <= kSteps; ++i)
        words.insert(words.end(), {"mousemove", std::to_string(from.x + (to.x - from.x) * i / kSteps),
                                   std::to_string(from.y + (to.y - from.y) * i / kSteps), "sleep", kFrame});
    words.insert(words.end(), {"sleep", kFrame, "mouseup", std::to_string(button), "sleep", kFrame});
    xdotool(words);
}

void VirtualDisplay::key(const std::string& name) const {
    xdotool({"keydown", name, "sleep", kFrame, "keyup", name, "sleep", kFrame});
}

void VirtualDisplay::drop(const std::string& title, const std::filesystem::path& file) const {
    std::string window = xdotool({"search", "--onlyvisible", "--name", title});
    window.resize(window.find('\n'));
    const std::string program =
        (std::filesystem::path(TOUCHSTONE_BINARY).parent_path() / "drop_file").string();
    if (runProgram({program, window, file.string()}, environment()).status != 0)
        throw std::runtime_error("the window took no file: " + file.string());
}

void VirtualDisplay::scroll(const Place& place, int notches) const {
    std::vector<std::string> words{"mousemove", std::to_string(place.x), std::to_string(place.y), "sleep",
                                   kFrame};
    for (int i = 0; i < std::abs(notches); ++i)
        words.insert(words.end(), {"click", notches > 0 ? "4" : "5", "sleep", kFrame});
    xdotool(words);
}

} // namespace touchstone::test

#pragma once
// A screen of the test's own (Xvfb), and a hand on its mouse (xdotool).

#include "tests/support/program.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace touchstone::test {

/// How long a test waits for what a window is to show: long enough for a machine that is busy, and for the
/// sanitizers.
#ifdef __SANITIZE_ADDRESS__
inline constexpr std::chrono::seconds kPatience{600};
#else
inline constexpr std::chrono::seconds kPatience{180};
#endif

/// What a screen showed at one moment.
struct ScreenPicture {
    int width = 0, height = 0;
    std::vector<std::array<uint8_t, 3>> pixels; ///< red, green, blue; rows from the top

    [[nodiscard]] const std::array<uint8_t, 3>& at(int x, int y) const {
        return pixels.at(static_cast<size_t>(y * width + x));
    }
};

class VirtualDisplay {
  public:
    /// Starts Xvfb on a free display number; throws std::runtime_error where that fails.
    VirtualDisplay(int width, int height);

    [[nodiscard]] const std::string& name() const { return name_; } ///< ":17"
    /// Everything that is on the screen now. Throws std::runtime_error where Xvfb does not tell.
    [[nodiscard]] ScreenPicture screen() const;
    [[nodiscard]] Environment environment() const { return {"DISPLAY=" + name_, "WAYLAND_DISPLAY="}; }

    /// xdotool with these arguments; returns what it prints. Throws std::runtime_error when it fails.
    std::string xdotool(std::vector<std::string> arguments) const;

    struct Place {
        int x = 0, y = 0;
    };
    /// Waits for a window whose title contains `title` and returns where its upper left corner is.
    [[nodiscard]] Place waitForWindow(const std::string& title) const;
    void move(const Place& place) const;
    void press(int button = 1) const;
    void release(int button = 1) const;
    void click(const Place& place, int button = 1) const;
    void drag(const Place& from, const Place& to, int button = 1) const;
    void key(const std::string& name) const;
    /// Drops a file on the window that is called so; throws where that does not take it.
    void drop(const std::string& title, const std::filesystem::path& file) const;
    /// Scrolls `notches` at a place, positive away from the user.
    void scroll(const Place& place, int notches) const;

  private:
    ScratchFolder scratch_;
    std::unique_ptr<BackgroundProgram> server_;
    std::string name_;
};

} // namespace touchstone::test

#pragma once
// The fixture of tests that drive the real window, as a person would: pointer and keys on a screen of its
// own.

#include "tests/unit/workbench/virtual_display.h"
#include "tests/unit/workbench/window_status.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace touchstone::test {

class WindowTest : public testing::Test {
  protected:
    /// Opens the window and waits for the model.
    void open(const std::string& scene, const std::vector<std::string>& more = {}) {
        start(scene, more);
        until("the model to be loaded",
              [](const Json& s) { return !s["loading"].get<bool>() && s["model"] != ""; });
    }
    void start(const std::string& scene, const std::vector<std::string>& more = {}) {
        std::filesystem::remove(status_.file());
        std::vector<std::string> arguments{TOUCHSTONE_BINARY,      scene, "--size", size_, "--status-json",
                                           status_.file().string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        Environment environment = display_.environment();
        environment.emplace_back("TOUCHSTONE_VALIDATION=1");
        environment.emplace_back("XDG_STATE_HOME=" + (scratch_ / "state").string());
        environment.emplace_back("TOUCHSTONE_FILE_DIALOG=window"); // whatever the desktop has
        environment.insert(environment.end(), environment_.begin(), environment_.end());
        program_ = std::make_unique<BackgroundProgram>(arguments, environment, scratch_ / "log");
        try {
            corner_ = display_.waitForWindow("Touchstone");
        } catch (const std::exception& error) {
            throw std::runtime_error(std::string(error.what()) +
                                     (program_->running() ? "" : "; it has ended") + ": " +
                                     readFile(scratch_ / "log"));
        }
    }

    Json status() { return status_.newest(*program_); }
    Json until(const std::string& what, const std::function<bool(const Json&)>& holds) {
        return status_.until(*program_, what, holds);
    }

    /// A status of the window after it has taken what was done before: a picture may be on its way that does
    /// not know of it, the next one takes it, and the one after shows what moves to another place because of
    /// it.
    Json later() {
        const Json before = status();
        const int frames = before.value("frames", 0);
        return until("a newer status", [&](const Json& s) {
            return s["update"] >= before["update"].get<int>() + 3 && s["frames"] >= frames + 3;
        });
    }
    /// A status whose means and largest values, which look back half a second, are of wholly after now.
    Json measured() {
        const double now = later()["time"];
        return until("newer means", [&](const Json& s) { return s["time"] >= now + 0.5; });
    }

    /// Where a widget is once it stays there: what has just been opened takes its place in later pictures.
    Json restingPlace(const std::string& widget) {
        const auto place = [&](const Json& s) {
            Json rect = s["widgets"].at(widget);
            rect.erase("note");
            return rect;
        };
        for (Json rect = place(status());;) {
            const Json next = place(later());
            if (next == rect)
                return rect;
            rect = next;
        }
    }
    VirtualDisplay::Place middleOf(const std::string& widget) {
        const Json rect = restingPlace(widget);
        return {corner_.x + static_cast<int>(rect["x"].get<double>() + 12.0),
                corner_.y + static_cast<int>(rect["y"].get<double>() + 0.5 * rect["height"].get<double>())};
    }
    /// A place in the picture, as shares of its width and height.
    VirtualDisplay::Place inPicture(double x, double y) {
        const Json rect = status()["widgets"].at("picture");
        return {corner_.x + static_cast<int>(rect["x"].get<double>() + x * rect["width"].get<double>()),
                corner_.y + static_cast<int>(rect["y"].get<double>() + y * rect["height"].get<double>())};
    }

    /// Clicks into a slider, at a share of its width.
    void slide(const std::string& name, double share) {
        const Json rect = restingPlace(name);
        display_.click(
            {corner_.x + static_cast<int>(rect["x"].get<double>() + share * rect["width"].get<double>()),
             corner_.y + static_cast<int>(rect["y"].get<double>() + 0.5 * rect["height"].get<double>())});
    }
    /// A file's path typed into the browser that Ctrl+O opens.
    void openByPath(const std::string& path) {
        display_.key("ctrl+o");
        until("the browser", [](const Json& s) { return s["widgets"].contains("openPath"); });
        display_.xdotool({"type", "--delay", "20", path});
        later();
        display_.key("Return");
    }

    void expectCleanEnd() {
        const Json last = status();
        EXPECT_EQ(last["validation_messages"], 0) << readFile(scratch_ / "log");
        EXPECT_EQ(last["allocations_in_tick"], 0);
        EXPECT_EQ(program_->stop(), 0) << readFile(scratch_ / "log");
    }

    ScratchFolder scratch_;
    WindowStatus status_{scratch_ / "status.json", scratch_ / "log",
                         Json{{"update", 0}, {"loading", true}, {"model", ""}}};
    /// Where a whole list of sliders is seen.
    static constexpr const char* kTall = "1000x780";
    std::string size_ = "900x600"; ///< of the window: the CPU draws it
    VirtualDisplay display_{1280, 800};
    Environment environment_; ///< of the program, besides what all have
    std::unique_ptr<BackgroundProgram> program_;
    VirtualDisplay::Place corner_;
};

} // namespace touchstone::test

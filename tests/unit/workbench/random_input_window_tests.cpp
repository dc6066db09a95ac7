// Keys, clicks, drags, texts and files in any order, as no person would: the window lives, the servo keeps
// its limits, and Space takes the force away whatever came before.

#include "engine/device_io/device_io.h"
#include "tests/support/shared_files.h"
#include "tests/support/sweep.h"
#include "tests/unit/workbench/window_test.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <random>

namespace touchstone::test::random_input_window_tests {
namespace {

class RandomInput : public WindowTest {
  protected:
    void SetUp() override {
        environment_.emplace_back("HOME=" + scratch_.path().string());
        environment_.emplace_back("XDG_CACHE_HOME=" + (scratch_ / "cache").string());
        for (const auto& entry : std::filesystem::directory_iterator(TOUCHSTONE_ASSETS))
            if (entry.path().extension() == ".glb" && entry.file_size() < 500'000) {
                models_.push_back(scratch_ / entry.path().filename().string());
                std::filesystem::copy_file(entry.path(), models_.back());
            }
        std::ranges::sort(models_);
        files_ = models_;
        if (const auto hostile = hostileFolder()) { // what is opened may be saved
            std::filesystem::copy(*hostile, scratch_ / "hostile", std::filesystem::copy_options::recursive);
            for (const auto& entry : std::filesystem::directory_iterator(scratch_ / "hostile"))
                if (entry.is_regular_file() && entry.path().extension() != ".json")
                    files_.push_back(entry.path());
        }
        std::ranges::sort(files_);
    }

    uint32_t below(size_t end) { return static_cast<uint32_t>(random_() % end); }
    template <class List>
    const auto& oneOf(const List& list) {
        return list[below(std::size(list))];
    }

    std::string keyName() {
        constexpr const char* kNamed[]{"Escape", "Return", "Tab",       "space", "BackSpace", "Delete",
                                       "Left",   "Right",  "Up",        "Down",  "Page_Up",   "Page_Down",
                                       "Home",   "End",    "plus",      "minus", "slash",     "question",
                                       "comma",  "period", "KP_Enter",  "KP_1",  "KP_7",      "bracketleft",
                                       "Insert", "Menu",   "semicolon", "equal"};
        constexpr const char* kModifiers[]{"", "", "", "", "ctrl+", "shift+", "alt+", "ctrl+shift+"};
        const std::string modifier = oneOf(kModifiers);
        std::string key;
        if (const uint32_t kind = below(10); kind < 4)
            key = std::string(1, static_cast<char>('a' + below(26)));
        else if (kind == 4)
            key = std::string(1, static_cast<char>('0' + below(10)));
        else if (kind < 8)
            key = "F" + std::to_string(1 + below(12));
        else
            key = oneOf(kNamed);
        // What ends the program ends the test's work.
        return key == "q" || (modifier == "alt+" && key == "F4") ? "Escape" : modifier + key;
    }

    /// On a control, or anywhere.
    VirtualDisplay::Place place(const Json& widgets) {
        if (below(3) == 0 || widgets.empty())
            return {corner_.x + static_cast<int>(below(1000)), corner_.y + static_cast<int>(below(780))};
        const Json rect =
            std::next(widgets.begin(), static_cast<std::ptrdiff_t>(below(widgets.size()))).value();
        const auto within = [&](const char* from, const char* size) {
            return static_cast<int>(rect[from].get<double>() +
                                    rect[size].get<double>() * 0.01 * (5.0 + below(90)));
        };
        // What is scrolled away lies beyond the window.
        return {std::max(corner_.x + within("x", "width"), 0),
                std::max(corner_.y + within("y", "height"), 0)};
    }

    /// One thing that a hand does, as words for xdotool.
    std::vector<std::string> deed(const Json& widgets) {
        constexpr const char* kTexts[]{"1e30",   "-1",  "nan", "0.5",      "3", "name",
                                       "1e-300", "inf", "/",   "../x.glb", ";"};
        constexpr const char* kButtons[]{"1", "1", "1", "1", "1", "2", "3"};
        const auto moved = [&] {
            const VirtualDisplay::Place to = place(widgets);
            return std::vector<std::string>{"mousemove", std::to_string(to.x), std::to_string(to.y)};
        };
        std::vector<std::string> words;
        const auto add = [&](std::vector<std::string> more) {
            words.insert(words.end(), more.begin(), more.end());
        };
        const std::string button = oneOf(kButtons);
        switch (below(9)) {
        case 0:
        case 1:
        case 2:
            add({"key", keyName()});
            break;
        case 3:
        case 4:
        case 5:
            add(moved());
            add({"sleep", "0.05", "mousedown", button, "sleep", below(2) == 0 ? "0.06" : "0", "mouseup",
                 button});
            break;
        case 6:
            add(moved());
            add({"mousedown", button});
            for (uint32_t i = 0, count = 1 + below(4); i < count; ++i) {
                add({"sleep", "0.04"});
                add(moved());
                if (below(8) == 0)
                    add({"key", keyName()});
            }
            add({"mouseup", button});
            break;
        case 7:
            add(moved());
            add({"click", "--repeat", std::to_string(1 + below(6)), below(2) == 0 ? "4" : "5"});
            break;
        default:
            add({"type", "--delay", "10", "--", oneOf(kTexts)});
            break;
        }
        return words;
    }

    /// Some deeds, then what must hold. False where they ended the program, as a click on *Quit* may.
    bool actFor(int rounds) {
        for (int round = 0; round < rounds; ++round) {
            const Json widgets = status().value("widgets", Json::object());
            done_.clear();
            for (int i = 0; i < kDeeds && program_->running(); ++i) {
                const std::vector<std::string> words = deed(widgets);
                for (const std::string& word : words)
                    done_ += word + " ";
                display_.xdotool(words);
            }
            if (below(12) == 0 && program_->running()) {
                const std::filesystem::path file = oneOf(files_);
                done_ += "drop " + file.string();
                display_.drop("Touchstone", file);
            }
            if (below(12) == 0 && program_->running()) {
                const std::string width = std::to_string(300 + below(900)),
                                  height = std::to_string(200 + below(600));
                done_ += "size " + width + " " + height;
                display_.xdotool({"search", "--name", "Touchstone", "windowsize", width, height});
            }
            if (!program_->running())
                return false;
            const Json now = status();
            EXPECT_EQ(now.at("validation_messages"), 0) << done_;
            EXPECT_EQ(now.at("allocations_in_tick"), 0) << done_;
            EXPECT_LE(now.at("tick").at("command_n").get<double>(), DeviceLimits{}.maxForce + 1e-9) << done_;
        }
        return true;
    }

    /// Space takes the force away, whatever has the focus. What came before it may still wait for its frame,
    /// and give the force back after it.
    void takeAway() {
        const auto off = [](const Json& s) { return s["settings"]["forceEnabled"] == "off"; };
        Json now = later();
        for (Json next = later(); next["settings"] != now["settings"]; next = later())
            now = next;
        if (off(now))
            return;
        display_.xdotool({"key", "space"});
        until("the force to be off", off);
    }

    void episode(uint32_t seed, int rounds) {
        random_.seed(seed);
        std::vector<std::string> options;
        if (below(2) == 0)
            options = {"--hand", "simulated"};
        const std::filesystem::path model = oneOf(models_);
        SCOPED_TRACE("seed " + std::to_string(seed) + ", " + model.filename().string());
        done_ = "start";
        bool lives = true;
        try {
            start(model.string(), options);
            until("its first picture", [](const Json& s) { return s["update"] > 0; });
            constexpr int kUntilSpace = 5; // rounds
            for (int part = 0; part < rounds / kUntilSpace && lives; ++part) {
                lives = actFor(kUntilSpace);
                if (lives)
                    takeAway();
            }
        } catch (const std::exception& error) {
            lives = program_->running();
            EXPECT_FALSE(lives) << error.what();
        }
        EXPECT_EQ(lives ? program_->stop() : program_->wait(), 0) << "after " << done_ << "\n"
                                                                  << readFile(scratch_ / "log");
        EXPECT_EQ(readFile(scratch_ / "log").find("validation"), std::string::npos)
            << readFile(scratch_ / "log");
        std::printf("seed %u, %s%s\n", seed, model.filename().c_str(), lives ? "" : ": ended by a deed");
        std::fflush(stdout);
    }

    static constexpr int kDeeds = 8; ///< a round
    std::mt19937 random_;
    std::vector<std::filesystem::path> models_, files_;
    std::string done_;
};

TEST_F(RandomInput, LeavesTheWindowAliveAndTheForceInHand) {
    const char* const from = std::getenv("TOUCHSTONE_SEED");
    const auto first = static_cast<uint32_t>(from != nullptr ? std::atoi(from) : 1);
    const int episodes = repetitions(1, 20);
    for (int i = 0; i < episodes && !HasFailure(); ++i)
        episode(first + static_cast<uint32_t>(i), repetitions(15, 60));
}

} // namespace
} // namespace touchstone::test::random_input_window_tests

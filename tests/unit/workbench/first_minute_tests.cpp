// The first minute of somebody who has never seen the program: they drop a model of their own on the window,
// look at it, touch it, find out what the effects do, change how it feels, save it, open it again, record
// what they do and replay it.

#include "tests/unit/workbench/window_test.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

namespace touchstone::test::first_minute_tests {
namespace {

using Place = VirtualDisplay::Place;

class FirstMinute : public WindowTest {
  protected:
    void SetUp() override { std::filesystem::copy_file(TOUCHSTONE_ASSETS "/doughnut.glb", own_); }

    static bool touching(const Json& s) { return s["tick"]["contacts"].get<int>() > 0; }

    /// The part of the screen where the model is.
    [[nodiscard]] std::vector<std::array<uint8_t, 3>> picture() {
        const Json rect = status()["widgets"].at("picture");
        const ScreenPicture screen = display_.screen();
        std::vector<std::array<uint8_t, 3>> pixels;
        const auto at = [&](const char* name) { return static_cast<int>(rect[name].get<double>()); };
        for (int y = corner_.y + at("y"); y < corner_.y + at("y") + at("height"); ++y)
            for (int x = corner_.x + at("x"); x < corner_.x + at("x") + at("width"); ++x)
                pixels.push_back(screen.at(x, y));
        return pixels;
    }
    /// Share of the pixels that differ plainly.
    [[nodiscard]] static double changed(const std::vector<std::array<uint8_t, 3>>& a,
                                        const std::vector<std::array<uint8_t, 3>>& b) {
        size_t count = 0;
        for (size_t i = 0; i < a.size(); ++i) {
            int difference = 0;
            for (size_t c = 0; c < 3; ++c)
                difference += std::abs(a[i][c] - b.at(i)[c]);
            count += difference > 30 ? 1 : 0;
        }
        return static_cast<double>(count) / static_cast<double>(a.size());
    }
    /// A model is seen: many colours, and neither a dark nor a blank picture.
    void expectAPicture() {
        const auto pixels = picture();
        std::set<std::array<uint8_t, 3>> colours(pixels.begin(), pixels.end());
        double mean = 0.0;
        for (const auto& pixel : pixels)
            mean += (pixel[0] + pixel[1] + pixel[2]) / 3.0 / static_cast<double>(pixels.size());
        EXPECT_GT(colours.size(), 500u);
        EXPECT_GT(mean, 20.0);
        EXPECT_LT(mean, 235.0);
    }

    void welcomed() {
        open("", {});
        const Json s = later();
        EXPECT_EQ(s["model"], "effects.glb") << "there is something to touch from the beginning";
        EXPECT_TRUE(s["widgets"].contains("gotIt")) << "how to touch is said";
        expectAPicture();
    }

    /// The largest force across the mesh that the charts hold while the hand strokes to and fro around a
    /// place.
    double stroked(double x, double y) {
        const Place from = inPicture(x - 0.05, y), to = inPicture(x + 0.05, y);
        display_.move(from);
        display_.press();
        until("contact", touching);
        measured(); // the peaks are those of half a second: none is of the stroke before
        double most = 0.0;
        for (int turn = 0; turn < 32; ++turn) {
            const double share = 0.5 - 0.5 * std::cos(0.2 * turn);
            display_.move({static_cast<int>(from.x + share * (to.x - from.x)),
                           static_cast<int>(from.y + share * (to.y - from.y))});
            most = std::max(most, status()["charts"]["peaks"]["tangential"].get<double>());
        }
        display_.release();
        until("no contact", [](const Json& s) { return !touching(s); });
        return most;
    }

    /// Each switch changes what the charts show of its tile, by mouse.
    void seesWhatEachSwitchDoes() {
        display_.key("3");
        display_.key("1"); // from the front: three tiles side by side
        later();
        struct Tile {
            const char* key;
            double place;
            double least; // N across the mesh
        };
        for (const Tile& tile : {Tile{"F5", 0.24, 0.05}, Tile{"F6", 0.5, 0.08}, Tile{"F7", 0.76, 0.2}}) {
            SCOPED_TRACE(tile.key);
            EXPECT_GT(stroked(tile.place, 0.5), tile.least);
            display_.key(tile.key);
            EXPECT_LT(stroked(tile.place, 0.5), 0.02);
            display_.key(tile.key);
        }
        display_.key("Home");
    }

    void dropsTheirModel() {
        const auto before = picture();
        std::filesystem::copy_file(TOUCHSTONE_ASSETS "/box.glb", scratch_ / "box.glb");
        display_.drop("Touchstone", scratch_ / "box.glb");
        until("the box", [](const Json& s) { return s["model"] == "box.glb"; });
        later();
        EXPECT_GT(changed(before, picture()), 0.02) << "the other model is seen";
        display_.drop("Touchstone", own_);
        until("their model", [](const Json& s) { return s["model"] == "mine.glb"; });
        later();
        expectAPicture();
    }

    void looksAround() {
        const auto before = picture();
        const double yaw = status()["view"]["yaw"];
        display_.drag(inPicture(0.6, 0.5), inPicture(0.7, 0.45), 3);
        until("another view",
              [&](const Json& s) { return std::abs(s["view"]["yaw"].get<double>() - yaw) > 0.1; });
        later();
        EXPECT_GT(changed(before, picture()), 0.02);
        display_.key("Home");
        later();
    }

    struct Felt {
        double force = 0.0;      ///< N, the largest mean over half a second
        double tangential = 0.0; ///< the largest share of the force that friction and slopes have
    };
    /// Presses on the tube, left of its hole, and strokes to and fro.
    Felt stroke() {
        const Place from = inPicture(0.27, 0.5), to = inPicture(0.33, 0.44);
        display_.move(from);
        display_.press();
        until("contact", touching);
        later();
        Felt felt;
        for (int turn = 0; turn < 14; ++turn) {
            const double share = 0.5 - 0.5 * std::cos(0.7 * turn);
            display_.move({static_cast<int>(from.x + share * (to.x - from.x)),
                           static_cast<int>(from.y + share * (to.y - from.y))});
            const Json now = status(), &recent = now["recent"];
            felt.force = std::max(felt.force, recent["mean_force_n"].get<double>());
            if (recent["mean_force_n"] > 0.1)
                felt.tangential = std::max(felt.tangential, recent["mean_tangential_force_n"].get<double>() /
                                                                recent["mean_force_n"].get<double>());
        }
        display_.release();
        until("no contact", [](const Json& s) { return !touching(s); });
        later();
        return felt;
    }

    void touches() {
        const Felt felt = stroke();
        EXPECT_GT(felt.force, 0.3);
        EXPECT_LT(felt.force, 2.0);
        EXPECT_GT(felt.tangential, 0.2) << "the glaze rubs";
        display_.click(middleOf("gotIt"));
        until("the card to go", [](const Json& s) { return s["introduced"].get<bool>(); });
    }

    void togglesEachEffect() {
        for (const std::string effect : {"forceShading", "texture", "friction"}) {
            const std::string on = status()["settings"][effect];
            display_.click(middleOf(effect));
            until(effect + " to be off", [&](const Json& s) { return s["settings"][effect] == "off"; });
            if (effect == "friction") {
                EXPECT_LT(stroke().tangential, 0.15) << "only the slopes of the texture";
            }
            display_.click(middleOf(effect));
            until(effect + " to be back", [&](const Json& s) { return s["settings"][effect] == on; });
        }
        display_.key("space");
        until("no force", [](const Json& s) { return s["settings"]["forceEnabled"] == "off"; });
        display_.key("space");
        until("the force", [](const Json& s) { return s["settings"]["forceEnabled"] == "on"; });
    }

    /// What `inspect` says of the friction in the file.
    [[nodiscard]] double frictionInFile() {
        const auto json = scratch_ / "inspect.json";
        const ProgramResult result =
            runProgram({TOUCHSTONE_BINARY, "inspect", own_.string(), "--json", json.string()});
        EXPECT_EQ(result.status, 0) << result.err;
        return std::stod(Json::parse(readFile(json))["materials"][0]["haptic"]["staticFriction"]["value"]
                             .get<std::string>());
    }

    void editsFrictionAndSaves() {
        const double before = frictionInFile();
        display_.key("e");
        until("the editor", [](const Json& s) { return s["widgets"].contains("edit.staticFriction"); });
        slide("edit.staticFriction", 0.8);
        until("another friction", [](const Json& s) {
            return s["materials"]["edited"] == true && s["materials"]["working"] == false;
        });
        EXPECT_DOUBLE_EQ(frictionInFile(), before) << "nothing is written unasked";
        display_.key("ctrl+s");
        until("it to be saved",
              [&](const Json& s) { return s["materials"]["notice"] == "saved to " + own_.string(); });
        EXPECT_GT(frictionInFile(), before + 0.2);
        display_.key("e");
        until("no editor", [](const Json& s) { return !s["widgets"].contains("edit.staticFriction"); });
    }

    /// Another model, and theirs again: the new friction is what the file says and what the hand feels.
    void reopens() {
        const double saved = frictionInFile();
        openByPath(TOUCHSTONE_ASSETS "/plane.glb");
        until("the plane", [](const Json& s) { return s["model"] == "plane.glb"; });
        display_.drop("Touchstone", own_);
        until("their model", [](const Json& s) { return s["model"] == "mine.glb"; });
        EXPECT_GT(stroke().tangential, 0.4) << "saved: " << saved;
    }

    /// Recorded while it is stroked, found in the list, played, and the same to the last bit.
    void recordsAndReplays() {
        display_.key("F9");
        until("the recording", [](const Json& s) { return s["recording"]["on"].get<bool>(); });
        stroke();
        display_.key("F9");
        const std::string file = until(
            "its end", [](const Json& s) { return !s["recording"]["on"].get<bool>(); })["recording"]["file"];
        EXPECT_TRUE(std::filesystem::exists(file));
        display_.click(middleOf("recorded"));
        const std::string row = "recording:" + std::filesystem::path(file).filename().string();
        until("it in the list", [&](const Json& s) { return s["widgets"].contains(row); });
        display_.click(middleOf(row));
        until("the timeline", [](const Json& s) { return s["timeline"]["looking"].get<bool>(); });
        const auto before = picture();
        const auto atSecondHalf = [](const Json& s) {
            return s["timeline"]["cursor_s"] > 0.5 * s["timeline"]["length_s"].get<double>();
        };
        EXPECT_FALSE(atSecondHalf(status()));
        display_.click(middleOf("play"));
        until("the cursor to go on", atSecondHalf);
        EXPECT_GT(changed(before, picture()), 1e-4) << "the recorded hand is seen";
        display_.click(middleOf("verify"));
        const Json verified =
            until("the verdict", [](const Json& s) { return s["timeline"]["verified"] != nullptr; });
        EXPECT_EQ(verified["timeline"]["verified"]["equal"], true) << verified["timeline"].dump(2);
        display_.key("Escape");
        until("the live hand", [](const Json& s) { return !s["timeline"]["looking"].get<bool>(); });
        const ProgramResult replay = runProgram({TOUCHSTONE_BINARY, "replay", file});
        EXPECT_EQ(replay.status, 0) << replay.out << replay.err;
    }

    std::filesystem::path own_ = scratch_ / "mine.glb";
};

TEST_F(FirstMinute, OpensTouchesChangesSavesReopensRecordsAndReplays) {
    welcomed();
    seesWhatEachSwitchDoes();
    dropsTheirModel();
    looksAround();
    touches();
    togglesEachEffect();
    editsFrictionAndSaves();
    reopens();
    recordsAndReplays();
    expectCleanEnd();
}

} // namespace
} // namespace touchstone::test::first_minute_tests

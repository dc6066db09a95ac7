// Sound in the real window, on a machine whose only sound card is made up: ALSA reads a configuration of the
// test.

#include "tests/unit/workbench/window_test.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

namespace touchstone::test::sound_window_tests {
namespace {

const std::string kDoughnut = TOUCHSTONE_ASSETS "/doughnut.glb";

class SoundWindow : public WindowTest {
  protected:
    SoundWindow() {
        setenv("JACK_NO_START_SERVER", "1", 1);
        setenv("JACK_DEFAULT_SERVER", "touchstone-has-none", 1);
        setenv("ALSA_CONFIG_PATH", config_.c_str(), 1);
        card("# none\n");
    }
    void card(const std::string& text) { std::ofstream(config_) << text; }

    std::filesystem::path config_ = scratch_ / "asound.conf";
};

TEST_F(SoundWindow, WithoutASoundCardSaysSoAndGoesOn) {
    open(kDoughnut, {"--hand", "simulated"});
    EXPECT_EQ(later()["sound"]["on"], false) << "off at first";
    EXPECT_EQ(later()["sound"]["state"], "off");
    display_.key("s");
    const Json failed =
        until("the search to end", [](const Json& s) { return s["sound"]["state"] == "failed"; });
    EXPECT_NE(failed["sound"]["problem"].get<std::string>().find("there is no sound card"),
              std::string::npos);
    until("the hand to touch", [](const Json& s) { return s["recent"]["in_contact"] == true; });
    display_.click(middleOf("sound"));
    until("the sound to be off", [](const Json& s) { return s["sound"]["state"] == "off"; });
    // ALSA and JACK have said nothing to the terminal.
    const std::string log = readFile(scratch_ / "log");
    for (const char* word : {"ALSA", "ack server", "JACK"})
        EXPECT_EQ(log.find(word), std::string::npos) << log;
    expectCleanEnd();
}

TEST_F(SoundWindow, PlaysAtTheVolumeThatIsSetAndRemembersIt) {
    card("pcm.!default { type null }\n"); // swallows all, as fast as it comes
    open(kDoughnut, {"--hand", "simulated", "--sound"});
    const Json playing = until("a card", [](const Json& s) { return s["sound"]["state"] == "playing"; });
    EXPECT_EQ(playing["sound"]["card"], "default");
    EXPECT_EQ(playing["sound"]["on"], true);
    until("ticks to be played", [](const Json& s) { return s["sound"]["runs_dry"] > 0; });
    const Json slider = status()["widgets"].at("volume");
    display_.click(
        {corner_.x + static_cast<int>(slider["x"].get<double>() + 0.2 * slider["width"].get<double>()),
         corner_.y + static_cast<int>(slider["y"].get<double>() + 0.5 * slider["height"].get<double>())});
    const double volume = until("another volume", [](const Json& s) {
        return s["sound"]["volume"].get<double>() < 0.3;
    })["sound"]["volume"];
    expectCleanEnd();
    open(kDoughnut, {"--hand", "simulated"});
    const Json again =
        until("the card again", [](const Json& s) { return s["sound"]["state"] == "playing"; });
    EXPECT_NEAR(again["sound"]["volume"].get<double>(), volume, 1e-6);
    expectCleanEnd();
}

} // namespace
} // namespace touchstone::test::sound_window_tests

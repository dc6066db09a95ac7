// The animation panel in the real window: list, play, pause, scrub and speed, by the pointer.

#include "tests/unit/workbench/window_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace touchstone::test::animation_window_tests {
namespace {

const std::string kBreathing = TOUCHSTONE_ASSETS "/breathing.glb";

class AnimationWindowTest : public WindowTest {
  protected:
    static double placeOf(const Json& s) { return s["animation"]["at"]; }
};

TEST_F(AnimationWindowTest, PlaysPausesScrubsAndChangesSpeed) {
    open(kBreathing);
    until("the panel", [](const Json& s) { return s["widgets"].contains("playAnimation"); });
    const Json first = later(), second = later();
    EXPECT_EQ(first["animation"]["speed"], 1.0);
    EXPECT_NE(placeOf(first), placeOf(second)) << "it plays";
    const double duration = first["animation"]["duration"];
    ASSERT_GT(duration, 0.5);

    display_.click(middleOf("playAnimation"));
    const Json paused = until("it to pause", [](const Json& s) { return s["animation"]["speed"] == 0.0; });
    EXPECT_NEAR(placeOf(later()), placeOf(paused), 1e-9) << "it stands still, and does not jump";

    // Scrubbed while it stands: it stays where the pointer left it.
    for (const double share : {0.25, 0.75}) {
        slide("animationTime", share);
        const Json there = until("the place in the animation", [&](const Json& s) {
            return std::abs(placeOf(s) - share * duration) < 0.05 * duration;
        });
        EXPECT_EQ(there["animation"]["speed"], 0.0);
        EXPECT_NEAR(placeOf(later()), placeOf(there), 1e-9);
    }

    // A speed that is chosen while it stands is that with which it goes on, from where it stood.
    slide("animationSpeed", 0.875);
    EXPECT_EQ(later()["animation"]["speed"], 0.0);
    const double stood = placeOf(status());
    display_.click(middleOf("playAnimation"));
    const Json plays = until("it to play", [](const Json& s) { return s["animation"]["speed"] != 0.0; });
    EXPECT_NEAR(plays["animation"]["speed"].get<double>(), 1.5, 0.05);
    EXPECT_NE(placeOf(later()), stood);
    const double speed = plays["animation"]["speed"];
    const Json after = later();
    const double passed = after["tick"]["time"].get<double>() - plays["tick"]["time"].get<double>();
    const double wanted = std::remainder(placeOf(after) - placeOf(plays) - speed * passed, duration);
    EXPECT_NEAR(wanted, 0.0, 1e-6) << "as fast as it says";

    // Backwards, while it plays: it changes its speed without a jump.
    slide("animationSpeed", 0.25);
    EXPECT_LT(later()["animation"]["speed"], 0.0);
    expectCleanEnd();
}

/// The list: the other animation is opened, and plays.
TEST_F(AnimationWindowTest, AnotherOneIsChosenFromTheList) {
    open(kBreathing);
    until("the list", [](const Json& s) { return s["widgets"].contains("animation"); });
    const int playing = later()["animation"]["playing"];
    VirtualDisplay::Place choice = middleOf("animation");
    const double height = status()["widgets"]["animation"]["height"];
    display_.click(choice);
    later();
    choice.y += static_cast<int>((playing == 0 ? 2.0 : 1.2) * height); // the list is open beneath
    display_.click(choice);
    until("the other one", [&](const Json& s) {
        return !s["loading"].get<bool>() && s["animation"].is_object() &&
               s["animation"]["playing"] != playing;
    });
    expectCleanEnd();
}

} // namespace
} // namespace touchstone::test::animation_window_tests

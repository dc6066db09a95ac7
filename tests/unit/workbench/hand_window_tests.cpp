// What the simulated hand strokes, and its clutch and zoom, chosen in the real window.

#include "tests/unit/workbench/window_test.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace touchstone::test::hand_window_tests {
namespace {

const std::string kDoughnut = TOUCHSTONE_ASSETS "/doughnut.glb";

std::array<double, 3> hipOf(const Json& s) {
    return {s["tick"]["hip"][0], s["tick"]["hip"][1], s["tick"]["hip"][2]};
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

TEST_F(WindowTest, StrokesAreChosenByKeyAndCommandLine) {
    open(kDoughnut, {"--hand", "simulated", "--stroke", "press", "--stroke-depth", "0.004"});
    Json s =
        until("the hand to press 4 mm", [](const Json& now) { return now["recent"]["mean_force_n"] > 1.5; });
    EXPECT_EQ(s["stroke"]["name"], "press");
    display_.key("n");
    until("the next stroke", [](const Json& now) { return now["stroke"]["name"] == "tap"; });
    for (int i = 0; i < 2; ++i) {
        display_.key("shift+n");
        later();
    }
    s = until("the tour", [](const Json& now) { return now["stroke"]["name"] == "tour"; });
    until("it to touch", [](const Json& now) { return now["recent"]["in_contact"].get<bool>(); });
    expectCleanEnd();
}

TEST_F(WindowTest, TheClutchHoldsTheHandAndZoomGoesAboutIt) {
    open(kDoughnut, {"--hand", "simulated", "--stroke", "circle"});
    until("the hand to circle", [](const Json& s) { return s["recent"]["mean_force_n"] > 0.4; });
    display_.xdotool({"keydown", "c"});
    const Json held =
        until("the force to be gone", [](const Json& s) { return s["workspace"]["coupling"] == 0.0; });
    EXPECT_EQ(held["workspace"]["text"], "clutch");
    const Json still = later();
    EXPECT_LT(distance(hipOf(held), hipOf(still)), 1e-12) << "though the hand goes on";
    display_.xdotool({"keyup", "c"});
    const Json free =
        until("the force to be back", [](const Json& s) { return s["workspace"]["coupling"] == 1.0; });
    EXPECT_EQ(free["workspace"]["text"], "");
    for (int i = 0; i < 3; ++i)
        display_.key("Next"); // Page Down
    const Json fine = until("the zoom to be there", [](const Json& s) {
        return std::abs(s["workspace"]["zoom"].get<double>() - 0.512) < 1e-9;
    });
    EXPECT_EQ(fine["workspace"]["text"], "zoom 0.512x");
    display_.key("Prior");
    until("the zoom to come back",
          [](const Json& s) { return std::abs(s["workspace"]["zoom"].get<double>() - 0.64) < 1e-9; });
    display_.click(middleOf("centre"));
    until("the hand to touch again", [](const Json& s) { return s["recent"]["in_contact"].get<bool>(); });
    expectCleanEnd();
}

} // namespace
} // namespace touchstone::test::hand_window_tests

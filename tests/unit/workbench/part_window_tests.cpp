// Hiding, isolating and clipping in the real window, and the views around it.

#include "tests/unit/workbench/window_test.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace touchstone::test::part_window_tests {
namespace {

const std::string kDoughnut = TOUCHSTONE_ASSETS "/doughnut.glb";
const std::string kEffects = TOUCHSTONE_ASSETS "/effects.glb";

class PartWindowTest : public WindowTest {
  protected:
    PartWindowTest() { size_ = kTall; }
    static bool touching(const Json& s) { return s["recent"]["mean_force_n"] > 0.2; }
    static bool inTheAir(const Json& s) { return s["recent"]["in_contact"] == false; }
    void viewMenu() {
        display_.click(middleOf("viewMenu"));
        until("the view menu", [](const Json& s) { return s["widgets"].contains("clip"); });
    }
};

TEST_F(PartWindowTest, WhatIsHiddenUnderTheHandLetsGoAndComesBack) {
    open(kDoughnut);
    const VirtualDisplay::Place ring = inPicture(0.5, 0.8); // its middle is a hole
    display_.move(ring);
    later();
    display_.press();
    until("the ring to be touched", touching);
    display_.key("h");
    until("it to be hidden", [](const Json& s) { return s["view"]["felt_hidden"] == Json{0}; });
    until("the hand to be free", inTheAir);
    EXPECT_EQ(later()["tick"]["command_n"], 0.0);
    display_.release();
    display_.key("alt+h");
    until("it to be back", [](const Json& s) { return s["view"]["felt_hidden"].empty(); });
    display_.press();
    until("it to be touched again", touching);
    display_.release();

    // The disc beside the node, and the menu of a right click.
    display_.click(middleOf("eye:0"));
    until("the node to be hidden", [](const Json& s) { return s["view"]["felt_hidden"] == Json{0}; });
    display_.click(middleOf("eye:0"));
    until("it to be back", [](const Json& s) { return s["view"]["felt_hidden"].empty(); });
    display_.move(ring);
    later();
    display_.click(ring, 3);
    until("the menu", [](const Json& s) { return s["widgets"].contains("hideObject"); });
    display_.click(middleOf("hideObject"));
    until("it to be hidden", [](const Json& s) { return s["view"]["felt_hidden"] == Json{0}; });
    expectCleanEnd();
}

TEST_F(PartWindowTest, ShiftHIsolatesOneOfMany) {
    open(kEffects);
    until("objects", [](const Json& s) { return s["widgets"].contains("eye:1"); });
    display_.move(inPicture(0.5, 0.5));
    later();
    display_.key("shift+h");
    const Json one =
        until("all else to be hidden", [](const Json& s) { return s["view"]["felt_hidden"].size() > 0; });
    EXPECT_EQ(one["view"]["hidden"], one["view"]["felt_hidden"]);
    display_.press();
    until("what is left to be touched", touching);
    display_.release();
    expectCleanEnd();
}

TEST_F(PartWindowTest, APlaneCutsWhatIsSeenAndFelt) {
    open(kDoughnut);
    // Across the view the plane takes away the half that faces the eye.
    display_.key("alt+b");
    until("the plane", [](const Json& s) { return s["view"]["clipped"] == true; });
    display_.move(inPicture(0.5, 0.8));
    later();
    display_.press();
    until("the inside to be touched", touching);
    display_.release();
    viewMenu();
    display_.click(middleOf("clip:x"));
    later();
    slide("clip:place", 0.02);
    until("the plane to be at the far end of x",
          [](const Json& s) { return s["view"]["clip_offset"] < -0.04; });
    display_.key("Escape");
    later();
    display_.move(inPicture(0.5, 0.8));
    later();
    display_.press();
    until("the hand in the air", inTheAir);
    display_.release();
    display_.key("alt+b");
    until("no plane", [](const Json& s) { return s["view"]["clipped"] == false; });
    expectCleanEnd();
}

/// Which sides a cut shows is a matter of what is felt. Failed: no edit came into the picture.
TEST_F(PartWindowTest, AnEditOfMaterialsIsSeenInACut) {
    open(kDoughnut);
    display_.key("alt+b");
    until("the plane", [](const Json& s) { return s["view"]["clipped"] == true; });
    display_.key("e");
    until("the editor", [](const Json& s) { return s["widgets"].contains("edit.staticFriction"); });
    EXPECT_EQ(later()["picture"]["other_materials"], 0);
    slide("edit.staticFriction", 0.8);
    until("it in the picture", [](const Json& s) { return s["picture"]["other_materials"] > 0; });
    expectCleanEnd();
}

/// Density that falls from the middle: a ball at every value of its surface.
std::string ballVolume(const std::filesystem::path& folder) {
    constexpr int kSide = 24;
    std::string nrrd = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 24 24 24\nspacings: 4 4 4\n"
                       "encoding: raw\n\n";
    for (int voxel = 0; voxel < kSide * kSide * kSide; ++voxel) {
        const double x = voxel % kSide - 11.5, y = voxel / kSide % kSide - 11.5,
                     z = voxel / (kSide * kSide) - 11.5;
        nrrd += static_cast<char>(
            static_cast<uint8_t>(std::clamp(200.0 - 10.0 * std::sqrt(x * x + y * y + z * z), 0.0, 250.0)));
    }
    std::string file = (folder / "ball.nrrd").string();
    std::ofstream(file, std::ios::binary) << nrrd;
    return file;
}

/// Failed: with every other value of the surface all came back that was hidden or cut away.
TEST_F(PartWindowTest, AnotherSurfaceOfAVolumeKeepsThePart) {
    open(ballVolume(scratch_ / ""));
    const double iso = later()["view"]["iso"];
    display_.key("alt+b");
    until("the plane", [](const Json& s) { return s["view"]["clipped"] == true; });
    slide("iso", 0.4);
    until("another surface", [&](const Json& s) { return s["view"]["iso"] != iso && s["loading"] == false; });
    until("it to be cut", [](const Json& s) { return s["view"]["clipped"] == true; });
    expectCleanEnd();
}

/// The answer comes while another value of the surface loads, or is there: it is not replaced by the file's
/// own.
TEST_F(PartWindowTest, DiscardedMaterialsLeaveTheChosenSurface) {
    open(ballVolume(scratch_ / ""));
    const double first = later()["view"]["iso"];
    display_.key("e");
    until("the editor", [](const Json& s) { return s["widgets"].contains("edit.staticFriction"); });
    slide("edit.staticFriction", 0.8);
    until("an edit", [](const Json& s) { return s["materials"]["edited"] == true; });
    slide("iso", 0.4);
    until("the question", [](const Json& s) { return s["leaving"].get<bool>(); });
    slide("iso", 0.7); // another one, while it is asked
    display_.key("d");
    const Json left = until("the surface", [](const Json& s) {
        return !s["leaving"].get<bool>() && s["loading"] == false && s["materials"]["edited"] == false;
    });
    EXPECT_GT(std::abs(left["view"]["iso"].get<double>() - first), 1.0);
    expectCleanEnd();
}

/// The pointer meets what it is over in an orthographic view, too.
TEST_F(PartWindowTest, TheMouseTouchesWhatItIsOverInEveryProjection) {
    open(kDoughnut);
    const auto hipUnderPointer = [&] {
        display_.move(inPicture(0.5, 0.8));
        later();
        display_.press();
        const Json s = until("touch", touching);
        display_.release();
        later();
        return s["tick"]["proxy"];
    };
    const Json perspective = hipUnderPointer();
    display_.key("5");
    until("the projection", [](const Json& s) { return s["view"]["orthographic"] == true; });
    const Json parallel = hipUnderPointer();
    for (size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(parallel[axis].get<double>(), perspective[axis].get<double>(), 0.02) << "about there";
    for (const char* key : {"z", "l"})
        display_.key(key);
    until("edges and grid",
          [](const Json& s) { return s["view"]["wireframe"] == true && s["view"]["grid"] == true; });
    // Pointer and click within a frame: failed, the picture had it.
    const VirtualDisplay::Place above = middleOf("axis:+y");
    display_.xdotool({"mousemove", std::to_string(above.x), std::to_string(above.y), "click", "1"});
    until("the view from above", [](const Json& s) { return s["view"]["pitch"] > 1.57; });
    display_.click(middleOf("axis:+x"));
    until("the view from the right", [](const Json& s) {
        return std::abs(s["view"]["pitch"].get<double>()) < 1e-9 &&
               std::abs(s["view"]["yaw"].get<double>() - 1.5708) < 1e-3;
    });
    expectCleanEnd();
}

TEST_F(PartWindowTest, TheCommandLineHidesAndAWrongNameIsTold) {
    open(kDoughnut, {"--hide", "nose"});
    const Json s = until("the problem", [](const Json& now) { return now["problem"] != ""; });
    EXPECT_NE(s["problem"].get<std::string>().find("there is no object 'nose'"), std::string::npos);
    EXPECT_NE(s["problem"].get<std::string>().find("doughnut"), std::string::npos);
    EXPECT_TRUE(s["view"]["hidden"].empty());
    EXPECT_EQ(program_->stop(), 0);
    open(kDoughnut, {"--hide", "doughnut"});
    until("it to be hidden", [](const Json& now) { return now["view"]["felt_hidden"] == Json{0}; });
    expectCleanEnd();
}

} // namespace
} // namespace touchstone::test::part_window_tests

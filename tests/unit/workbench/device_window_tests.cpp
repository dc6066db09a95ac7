// The window's device selector, with HID devices that are not there.

#include "devices/hid/raw_report.h"
#include "tests/support/mock_hid.h"
#include "tests/unit/workbench/window_test.h"

#include <cmath>

namespace touchstone::test {
namespace {

/// Where a device of our own protocol says that it is, 20 mm right and 90 mm up.
Bytes place(uint32_t sequence) {
    const auto state =
        rawState({.flags = kRawHomed, .sequence = sequence, .axes = {20'000'000, 90'000'000, 0, 0, 0, 0}});
    return {state.begin(), state.end()};
}

bool handIsAtThePlace(const Json& s) {
    const auto hip = s["tick"]["hip"].get<std::vector<double>>();
    return std::hypot(hip[0] - 0.02, hip[1] - 0.09, hip[2]) < 1e-6;
}

TEST_F(WindowTest, ADevicePluggedInWhileRunningIsHeldUnpluggedAndLetGo) {
    MockBus bus;
    const auto doubtful = bus.plug({.vendor = 0x16c0, .product = 0x0486, .name = "My experiment"});
    open(TOUCHSTONE_ASSETS "/box.glb");
    EXPECT_FALSE(status()["widgets"].contains("device"))
        << "nothing to choose from: many boards have the ids of a WoodenHaptics";
    const auto diy = bus.plug({.vendor = 0x1209, .product = 0x0001, .name = "DIY"});
    const Json offered =
        until("the device to be offered", [](const Json& s) { return s["widgets"].contains("device"); });
    VirtualDisplay::Place choice = middleOf("device");
    display_.click(choice);
    later();
    choice.y += static_cast<int>(1.2 * offered["widgets"]["device"]["height"].get<double>());
    display_.click(choice);
    until("the device to be held", [&](const Json& s) { return s["device"] == diy->node(); });
    until("it to be connected",
          [&](const Json& s) { return s["device_status"] == "DIY device at " + diy->node(); });
    uint32_t sequence = 0;
    until("the hand to be where the device is", [&](const Json& s) {
        diy->say(place(++sequence));
        return handIsAtThePlace(s);
    });
    diy->unplug();
    until("the window to say that it was unplugged", [](const Json& s) {
        return s["device_status"].get<std::string>().find("plugged") != std::string::npos;
    });
    display_.click(middleOf("mouse"));
    until("the mouse to be the hand",
          [](const Json& s) { return s["device"] == "" && s["hand"] == "mouse"; });
    expectCleanEnd();
}

/// The mouse presses while a simulated hand strokes: each has its probe, its force and its line in the panel,
/// and the force key takes both forces.
TEST_F(WindowTest, TwoHandsTouchAtOnce) {
    size_ = kTall;
    open(TOUCHSTONE_ASSETS "/box.glb", {"--device", "mouse", "--device", "hand"});
    const Json alone = until("the second hand to touch", [](const Json& s) {
        const Json& other = s["other_hands"][0];
        return other["contacts"] > 0 && other["force_n"] > 0.0 && other["command_n"] > 0.0;
    });
    EXPECT_EQ(alone["other_hands"][0]["name"], "simulated hand");
    EXPECT_EQ(alone["tick"]["contacts"], 0) << "the mouse does not touch yet";
    EXPECT_TRUE(alone["widgets"].contains("hand2"));
    const VirtualDisplay::Place at = inPicture(0.5, 0.5);
    display_.xdotool({"mousemove", std::to_string(at.x), std::to_string(at.y), "mousedown", "1"});
    until("both to touch", [](const Json& s) {
        return s["tick"]["contacts"] > 0 && s["tick"]["command_n"] > 0.0 &&
               s["other_hands"][0]["contacts"] > 0 && s["other_hands"][0]["command_n"] > 0.0;
    });
    display_.key("space");
    until("both forces to be off", [](const Json& s) {
        return s["settings"]["forceEnabled"] == "off" && s["tick"]["command_n"] == 0.0 &&
               s["other_hands"][0]["command_n"] == 0.0;
    });
    display_.xdotool({"mouseup", "1"});
    expectCleanEnd();
}

TEST_F(WindowTest, ASecondHandHoldsADeviceOfItsOwn) {
    MockBus bus;
    const auto diy = bus.plug({.vendor = 0x1209, .product = 0x0001, .name = "DIY"});
    open(TOUCHSTONE_ASSETS "/box.glb", {"--device", "mouse", "--device", diy->node()});
    uint32_t sequence = 0;
    const Json held = until("the second hand to be where its device is", [&](const Json& s) {
        diy->say(place(++sequence));
        const auto hip = s["other_hands"][0]["hip"].get<std::vector<double>>();
        return std::hypot(hip[0] - 0.02, hip[1] - 0.09, hip[2]) < 1e-6;
    });
    EXPECT_EQ(held["other_hands"][0]["name"], "DIY device");
    EXPECT_EQ(held["other_hands"][0]["status"], "at " + diy->node());
    EXPECT_EQ(held["device"], "") << "the mouse is the first hand";
    diy->unplug();
    until("the window to say that it was unplugged", [](const Json& s) {
        return s["other_hands"][0]["status"].get<std::string>().find("plugged") != std::string::npos &&
               !s["other_hands"][0]["valid"];
    });
    expectCleanEnd();
}

} // namespace
} // namespace touchstone::test

int main(int argc, char** argv) {
    touchstone::test::enterMockEnvironment(argv);
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}

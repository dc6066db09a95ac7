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

} // namespace
} // namespace touchstone::test

int main(int argc, char** argv) {
    touchstone::test::enterMockEnvironment(argv);
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}

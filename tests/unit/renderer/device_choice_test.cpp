#include "engine/core/error.h"
#include "renderer/device_choice.h"

#include <gtest/gtest.h>

namespace touchstone {
namespace {

const std::vector<DeviceCandidate> kMachine{
    {"llvmpipe (LLVM 15.0.6, 256 bits)", DeviceKind::Software, ""},
    {"Intel(R) UHD Graphics 630", DeviceKind::Integrated, ""},
    {"Old Card", DeviceKind::Discrete, "Vulkan 1.1 only, 1.3 is needed"},
    {"Radeon RX 6700", DeviceKind::Discrete, ""},
    {"Radeon RX 7900", DeviceKind::Discrete, ""}};

TEST(ChooseDevice, TakesTheBestKindAndTheFirstAmongEquals) {
    EXPECT_EQ(chooseDevice(kMachine, ""), 3u);
    EXPECT_EQ(chooseDevice({kMachine[0], kMachine[1]}, ""), 1u);
    EXPECT_EQ(chooseDevice({kMachine[0]}, ""), 0u);
    EXPECT_EQ(chooseDevice({kMachine[2], kMachine[0]}, ""), 1u) << "a bad driver is no reason to give up";
}

TEST(ChooseDevice, NameInAnyCaseAndNumberOverride) {
    EXPECT_EQ(chooseDevice(kMachine, "LLVMPIPE"), 0u);
    EXPECT_EQ(chooseDevice(kMachine, "7900"), 4u)
        << "a number beyond the list is a part of a name, or nothing";
    EXPECT_EQ(chooseDevice(kMachine, "1"), 1u);
    EXPECT_EQ(chooseDevice(kMachine, "radeon"), 3u);
}

TEST(ChooseDevice, SaysWhatThereIsWhenNothingFits) {
    try {
        (void)chooseDevice(kMachine, "old card");
        FAIL() << "chose an unfit device";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("Vulkan 1.1 only"), std::string::npos);
        EXPECT_NE(std::string(error.what()).find("3: Radeon RX 6700 (discrete)"), std::string::npos);
        EXPECT_NE(error.remedy().find("TOUCHSTONE_GPU"), std::string::npos);
    }
    EXPECT_THROW((void)chooseDevice(kMachine, "no such"), Error);
}

TEST(ChooseDevice, NoneAtAllNamesThePackage) {
    for (const auto& candidates :
         {std::vector<DeviceCandidate>{}, std::vector<DeviceCandidate>{kMachine[2]}}) {
        try {
            (void)chooseDevice(candidates, "");
            FAIL() << "chose from nothing";
        } catch (const Error& error) {
            EXPECT_NE(error.remedy().find("mesa-vulkan-drivers"), std::string::npos);
        }
    }
}

} // namespace
} // namespace touchstone

#include "devices/choice/device_choice.h"
#include "devices/hid/hid_list.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>

namespace touchstone {
namespace {

TEST(HidList, KnowsOurDevicesByTheirIds) {
    ASSERT_NE(knownHid(0x046d, 0xc626), nullptr);
    EXPECT_EQ(knownHid(0x046d, 0xc626)->kind, HidKind::SpaceMouse);
    ASSERT_NE(knownHid(0x256f, 0xc635), nullptr);
    ASSERT_NE(knownHid(0x16c0, 0x0486), nullptr);
    EXPECT_EQ(knownHid(0x16c0, 0x0486)->kind, HidKind::WoodenHaptics);
    EXPECT_EQ(knownHid(0x046d, 0xc077), nullptr) << "an ordinary mouse";
    EXPECT_EQ(knownHid(0x256f, 0xc626), nullptr) << "the product id of another vendor";
}

TEST(HidList, NamesEveryDeviceOnce) {
    std::set<std::pair<int, int>> ids;
    for (const KnownHid& known : knownHids()) {
        EXPECT_TRUE(ids.emplace(known.vendor, known.product).second) << std::hex << known.product;
        EXPECT_STRNE(known.model, "");
    }
    EXPECT_EQ(ids.size(), 23u);
}

TEST(HidList, CallsADeviceByTheBestNameThereIs) {
    HidNode device;
    device.vendor = 0x1234;
    device.product = 0x00ab;
    EXPECT_EQ(device.name(), "HID device 1234:00ab");
    device.productName = "Knob";
    EXPECT_EQ(device.name(), "Knob");
    device.known = knownHid(0x046d, 0xc626);
    EXPECT_EQ(device.name(), "SpaceNavigator");
}

TEST(HidList, TellsWhatTheUserMayDo) {
    const std::filesystem::path node =
        std::filesystem::temp_directory_path() / ("touchstone node " + std::to_string(::getpid()));
    std::ofstream(node) << "x";
    EXPECT_EQ(hidAccess(node.string()), HidAccess::ReadWrite);
    // Permissions do not bind root: the test becomes another user, who owns the file.
    constexpr uid_t kNobody = 65534;
    const bool root = ::geteuid() == 0;
    ASSERT_TRUE(!root ||
                (::chown(node.c_str(), kNobody, kNobody) == 0 && ::setresuid(kNobody, kNobody, 0) == 0));
    std::filesystem::permissions(node, std::filesystem::perms::owner_read);
    EXPECT_EQ(hidAccess(node.string()), HidAccess::ReadOnly);
    std::filesystem::permissions(node, std::filesystem::perms::none);
    EXPECT_EQ(hidAccess(node.string()), HidAccess::None);
    ASSERT_TRUE(!root || ::setresuid(0, 0, 0) == 0);
    std::filesystem::remove(node);
    EXPECT_EQ(hidAccess(node.string()), HidAccess::Missing);
}

TEST(HidList, GivesTheUdevRuleWhenPermissionIsMissing) {
    HidNode device;
    device.vendor = 0x256f;
    device.path = "/dev/hidraw3";
    device.access = HidAccess::None;
    EXPECT_NE(hidRemedy(device).find("ATTRS{idVendor}==\"256f\""), std::string::npos) << hidRemedy(device);
    device.access = HidAccess::ReadWrite;
    EXPECT_TRUE(hidRemedy(device).empty());
}

TEST(HidList, TheUdevRuleThatWeShipKnowsEveryDevice) {
    std::ifstream in(TOUCHSTONE_SOURCE "/devices/udev/70-touchstone.rules");
    std::vector<std::string> rules;
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("KERNEL==\"hidraw*\""))
            rules.push_back(line);
    const auto hex = [](unsigned id) {
        char text[8];
        std::snprintf(text, sizeof text, "%04x", id);
        return std::string(text);
    };
    const auto allowed = [&](unsigned vendor, unsigned product) {
        return std::any_of(rules.begin(), rules.end(), [&](const std::string& rule) {
            const bool anyProduct = rule.find("idProduct") == std::string::npos;
            return rule.find("ATTRS{idVendor}==\"" + hex(vendor) + "\"") != std::string::npos &&
                   (anyProduct || rule.find(hex(product)) != std::string::npos) &&
                   rule.find("TAG+=\"uaccess\"") != std::string::npos;
        });
    };
    for (const KnownHid& known : knownHids())
        EXPECT_TRUE(allowed(known.vendor, known.product)) << known.model;
    for (const DeviceFile& file : deviceFiles())
        EXPECT_TRUE(allowed(file.usb.vendor, file.usb.product)) << file.name;
    EXPECT_FALSE(allowed(0x046d, 0xc077)) << "not every Logitech mouse";
}

TEST(HidList, OursComeFirstAndNodesInTheOrderOfTheirNumbers) {
    HidNode two, ten, ours;
    two.path = "/dev/hidraw2";
    ten.path = "/dev/hidraw10";
    ours.path = "/dev/hidraw11";
    ours.known = &knownHids().front();
    EXPECT_TRUE(listedBefore(two, ten));
    EXPECT_FALSE(listedBefore(ten, two));
    EXPECT_TRUE(listedBefore(ours, two));
    EXPECT_FALSE(listedBefore(two, two));
}

TEST(HidList, ListsEachNodeOnceAndOursFirst) {
    const std::vector<HidNode> devices = listHidNodes();
    std::set<std::string> paths;
    bool unknownSeen = false;
    for (const HidNode& device : devices) {
        EXPECT_TRUE(paths.insert(device.path).second) << device.path;
        EXPECT_FALSE(unknownSeen && device.known != nullptr) << device.path;
        unknownSeen = unknownSeen || device.known == nullptr;
    }
}

} // namespace
} // namespace touchstone

#include "devices/hid/device_file.h"
#include "engine/core/error.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>

namespace touchstone {
namespace {

const std::string kGood = R"({
  "format": "touchstone-device", "version": 1, "name": "one hinge", "protocol": "touchstone-raw-hid",
  "usb": { "vendor": "1209", "product": "00aB", "interface": 1, "serial": "A7" },
  "arm": {
    "motors": [ { "countsPerTurn": 4000, "ratio": 0.1, "home": 0.5, "torqueConstant": 0.02, "maxCurrent": 1.5 } ],
    "joints": [ { "type": "hinge", "axis": [0, 0, 2], "offset": [0, 0, 0.1], "drive": [1] } ],
    "tip": [0.1, 0, 0],
    "frame": { "right": [0, 1, 0], "up": [0, 0, 1], "origin": [0.1, 0, 0.1] }
  },
  "limits": { "maxForce": 4, "recommendedStiffness": 300, "maxStiffness": 900, "staleAge": 0.03 }
})";

std::string replaced(const std::string& what, const std::string& by) {
    std::string text = kGood;
    const size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
}

TEST(DeviceFile, ReadsWhatItSays) {
    const DeviceFile file = parseDeviceFile(kGood, "good.json");
    EXPECT_EQ(file.name, "one hinge");
    EXPECT_EQ(file.usb.vendor, 0x1209);
    EXPECT_EQ(file.usb.product, 0x00ab);
    EXPECT_EQ(file.usb.interfaceNumber, 1);
    EXPECT_EQ(file.usb.serial, "A7");
    ASSERT_TRUE(file.arm);
    EXPECT_EQ(file.arm->motors[0].home, 0.5);
    EXPECT_EQ(file.arm->joints[0].axis, glm::dvec3(0, 0, 1)) << "made a unit";
    EXPECT_EQ(file.arm->deviceFromBase * glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1))
        << "x of the base to the user";
    EXPECT_EQ(file.limits.maxForce, 4.0);
    EXPECT_EQ(file.limits.maxForceRate, 4000.0) << "full force in a tick";
    EXPECT_EQ(file.limits.staleAge, 0.03);
    EXPECT_NEAR(file.limits.positionResolution, 2 * 3.14159265358979 / 4000 * 0.1 * 0.1, 1e-12);
}

TEST(DeviceFile, ADisplayOfTheContactLocationIsDeclared) {
    EXPECT_EQ(parseDeviceFile(kGood, "good.json").pad, PadLimits{});
    const std::string pad = R"("pad": { "reach": 0.008, "rate": 0.1 }, "limits")";
    const PadLimits declared{.reach = 0.008, .rate = 0.1};
    EXPECT_EQ(parseDeviceFile(replaced("\"limits\"", pad), "pad.json").pad, declared);
    for (const char* bad :
         {R"("pad": { "reach": 0.2, "rate": 0.1 }, "limits")", R"("pad": { "reach": 0.008 }, "limits")",
          R"("pad": { "reach": 0.008, "rate": -1 }, "limits")", R"("pad": 3, "limits")"})
        EXPECT_THROW((void)parseDeviceFile(replaced("\"limits\"", bad), "pad.json"), Error) << bad;
}

TEST(DeviceFile, TheFilesThatWeShipAreGood) {
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(TOUCHSTONE_SOURCE "/devices/files")) {
        EXPECT_NO_THROW((void)readDeviceFile(entry.path())) << entry.path();
        ++files;
    }
    EXPECT_EQ(files, 3);
}

struct Fault {
    const char *what, *by, *place, *problem;
};
class DeviceFileFault : public testing::TestWithParam<Fault> {};

TEST_P(DeviceFileFault, IsToldWithItsPlaceAndARemedy) {
    const Fault& fault = GetParam();
    try {
        (void)parseDeviceFile(replaced(fault.what, fault.by), "bad.json");
        FAIL() << "was taken for good";
    } catch (const Error& error) {
        EXPECT_EQ(error.file(), "bad.json");
        EXPECT_EQ(error.place(), fault.place) << error.what();
        EXPECT_NE(error.problem().find(fault.problem), std::string::npos) << error.what();
        EXPECT_FALSE(error.remedy().empty());
    }
}

INSTANTIATE_TEST_SUITE_P(
    OneEach, DeviceFileFault,
    testing::Values(Fault{"touchstone-device", "something", "format", "no device file"},
                    Fault{"\"version\": 1", "\"version\": 2", "version", "newer"},
                    Fault{"touchstone-raw-hid", "midi", "protocol", "'midi' is no protocol"},
                    Fault{"\"1209\"", "\"12O9\"", "usb.vendor", "not a USB id"},
                    Fault{"\"1209\"", "4617", "usb.vendor", "must be a text"},
                    Fault{"4000,", "0,", "arm.motors[0].countsPerTurn", "at least 1"},
                    Fault{"4000,", "\"many\",", "arm.motors[0].countsPerTurn", "must be a number"},
                    Fault{"\"ratio\": 0.1", "\"ratio\": 0", "arm.motors[0].ratio", "zero"},
                    Fault{"\"ratio\": 0.1,", "", "arm.motors[0]", "'ratio' is missing"},
                    Fault{", \"maxCurrent\": 1.5", "", "arm.motors[0]", "'maxCurrent' is missing"},
                    Fault{"\"maxCurrent\": 1.5", "\"maxCurrent\": 1e9", "arm.motors[0].maxCurrent",
                          "at most 100"},
                    Fault{"\"type\": \"hinge\"", "\"type\": \"spring\"", "arm.joints[0].type",
                          "'spring' is no kind of joint"},
                    Fault{"[0, 0, 2]", "[0, 0, 0]", "arm.joints[0].axis", "no length"},
                    Fault{"[0, 0, 2]", "[0, 2]", "arm.joints[0].axis", "list of 3"},
                    Fault{"\"drive\": [1]", "\"drive\": [1, 1]", "arm.joints[0].drive", "list of 1"},
                    Fault{"\"right\": [0, 1, 0]", "\"right\": [0, 1, 1]", "arm.frame", "perpendicular"},
                    Fault{"\"tip\"", "\"tipp\"", "arm", "unknown key 'tipp'"},
                    Fault{"\"maxForce\": 4", "\"maxForce\": -4", "limits.maxForce", "at least 0"},
                    Fault{"\"maxForce\": 4", "\"maxForce\": 400", "limits.maxForce", "at most 100"},
                    Fault{"\"recommendedStiffness\": 300", "\"recommendedStiffness\": 1000",
                          "limits.recommendedStiffness", "900"},
                    Fault{"\"limits\": {", "\"limit\": {", "", "unknown key 'limit'"},
                    Fault{"4000,", "1e999,", "", "too large"},
                    Fault{"\"version\": 1,", "\"version\": 1", "byte 54", "not JSON"}));

TEST(DeviceFile, AWoodenHapticsNeedsAnArmAndDrivesThreeMotors) {
    std::string text = replaced("touchstone-raw-hid", "woodenhaptics");
    EXPECT_NO_THROW((void)parseDeviceFile(text, "t"));
    const size_t begin = text.find("\"arm\""), end = text.find("\"limits\"");
    EXPECT_THROW((void)parseDeviceFile(text.substr(0, begin) + text.substr(end), "t"), Error);
}

TEST(DeviceFile, AFileThatIsNotThereIsAnError) {
    EXPECT_THROW((void)readDeviceFile("/nowhere/device.json"), Error);
}

/// Text that is damaged anywhere is read or refused, and never anything else.
TEST(DeviceFile, DamageIsRefusedNotFeltLater) {
    std::mt19937_64 random(31);
    int refused = 0;
    for (int i = 0; i < 20000; ++i) {
        std::string text = kGood;
        for (int k = 0; k < 2; ++k)
            text[random() % text.size()] = static_cast<char>(random() % 128);
        try {
            const DeviceFile file = parseDeviceFile(text, "t");
            EXPECT_LE(file.limits.maxForce, 100.0);
            EXPECT_GE(file.limits.maxForce, 0.0);
        } catch (const Error&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 5000);
}

} // namespace
} // namespace touchstone

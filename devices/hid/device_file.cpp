#include "devices/hid/device_file.h"

#include "engine/core/error.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <sstream>

namespace touchstone {

namespace {

using Json = nlohmann::json;

constexpr double kUnlimited = std::numeric_limits<double>::max();

/// A value in the file, with its path for errors.
class Node {
  public:
    Node(const Json& json, const std::string& file, std::string place)
        : json_(json), file_(file), place_(std::move(place)) {}

    [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const {
        throw Error(file_, place_, problem, remedy);
    }

    /// An object with no keys but these, so that a misspelt key is reported.
    const Node& object(std::initializer_list<const char*> keys) const {
        if (!json_.is_object())
            fail("must be an object", "write { … }");
        for (const auto& [key, value] : json_.items()) {
            if (std::find(keys.begin(), keys.end(), key) != keys.end())
                continue;
            std::string allowed;
            for (const char* name : keys)
                allowed += std::string(allowed.empty() ? "" : ", ") + name;
            fail("unknown key '" + key + "'", "known here: " + allowed);
        }
        return *this;
    }
    [[nodiscard]] bool has(const char* key) const { return json_.contains(key); }
    [[nodiscard]] Node operator[](const char* key) const {
        if (!json_.contains(key))
            fail("'" + std::string(key) + "' is missing", "add it; docs/devices.md says what it means");
        return {json_[key], file_, place_.empty() ? key : place_ + "." + key};
    }
    [[nodiscard]] Node at(size_t i) const {
        return {json_[i], file_, place_ + "[" + std::to_string(i) + "]"};
    }

    [[nodiscard]] size_t array(size_t least, size_t most) const {
        if (!json_.is_array() || json_.size() < least || json_.size() > most)
            fail("must be a list of " + std::to_string(least) +
                     (least == most ? "" : " to " + std::to_string(most)),
                 "write [ … ]");
        return json_.size();
    }
    [[nodiscard]] std::string text() const {
        if (!json_.is_string())
            fail("must be a text", "put it in quotes");
        return json_.get<std::string>();
    }
    [[nodiscard]] double number(double least, double most) const {
        const double value = json_.is_number() ? json_.get<double>() : std::nan("");
        if (!(value >= least && value <= most)) {
            std::ostringstream range;
            range << "must be a number ";
            if (least > -kUnlimited)
                range << "of at least " << least << (most < kUnlimited ? " and " : "");
            if (most < kUnlimited)
                range << "of at most " << most;
            fail(range.str(), "SI units: m, rad, N, A, s");
        }
        return value;
    }
    [[nodiscard]] glm::dvec3 vector() const {
        (void)array(3, 3);
        constexpr double kMax = 1e3;
        return {at(0).number(-kMax, kMax), at(1).number(-kMax, kMax), at(2).number(-kMax, kMax)};
    }
    [[nodiscard]] glm::dvec3 direction() const {
        const glm::dvec3 v = vector();
        if (!(glm::length(v) > 1e-6))
            fail("has no length, so it points nowhere", "write a direction, such as [0, 0, 1]");
        return glm::normalize(v);
    }
    /// Four hexadecimal digits, as lsusb prints them.
    [[nodiscard]] uint16_t usbId() const {
        const std::string digits = text();
        const bool hexadecimal =
            digits.size() == 4 && digits.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
        if (!hexadecimal)
            fail("'" + digits + "' is not a USB id",
                 "four hexadecimal digits, as lsusb prints them: \"16c0\"");
        return static_cast<uint16_t>(std::stoul(digits, nullptr, 16));
    }

  private:
    const Json& json_;
    const std::string& file_;
    std::string place_;
};

UsbMatch readUsb(const Node& node) {
    node.object({"vendor", "product", "interface", "serial"});
    UsbMatch usb;
    usb.vendor = node["vendor"].usbId();
    usb.product = node["product"].usbId();
    if (node.has("interface"))
        usb.interfaceNumber = static_cast<int>(node["interface"].number(0, 255));
    if (node.has("serial"))
        usb.serial = node["serial"].text();
    return usb;
}

ArmMotor readMotor(const Node& node) {
    node.object({"countsPerTurn", "ratio", "home", "torqueConstant", "maxCurrent"});
    ArmMotor motor;
    motor.countsPerTurn = node["countsPerTurn"].number(1, 1e9);
    motor.ratio = node["ratio"].number(-1e3, 1e3);
    if (motor.ratio == 0.0)
        node["ratio"].fail("is zero: the motor would move nothing", "body angle for one radian of the motor");
    if (node.has("home"))
        motor.home = node["home"].number(-1e3, 1e3);
    if (node.has("torqueConstant"))
        motor.torqueConstant = node["torqueConstant"].number(0, 1e3);
    if (motor.torqueConstant > 0.0)
        motor.maxCurrent = node["maxCurrent"].number(0, 100);
    return motor;
}

ArmJoint readJoint(const Node& node, size_t motors) {
    node.object({"type", "axis", "offset", "drive"});
    ArmJoint joint;
    const std::string type = node["type"].text();
    if (type != "hinge" && type != "slide")
        node["type"].fail("'" + type + "' is no kind of joint", "hinge or slide");
    joint.slides = type == "slide";
    joint.axis = node["axis"].direction();
    if (node.has("offset"))
        joint.offset = node["offset"].vector();
    const Node drive = node["drive"];
    (void)drive.array(motors, motors);
    for (size_t m = 0; m < motors; ++m)
        joint.drive[m] = drive.at(m).number(-1e3, 1e3);
    return joint;
}

/// Rows: the axes of the device frame in the base frame.
glm::dmat3 readFrame(const Node& node) {
    const glm::dvec3 right = node["right"].direction(), up = node["up"].direction();
    if (std::abs(glm::dot(right, up)) > 1e-6)
        node.fail("'right' and 'up' are not perpendicular", "two axes of the base, as the user sees them");
    return glm::transpose(glm::dmat3(right, up, glm::cross(right, up)));
}

ArmKinematics readArm(const Node& node) {
    node.object({"motors", "joints", "tip", "frame"});
    ArmKinematics arm;
    const Node motors = node["motors"], joints = node["joints"];
    for (size_t m = 0; m < motors.array(1, kMaxMotors); ++m)
        arm.motors.push_back(readMotor(motors.at(m)));
    for (size_t j = 0; j < joints.array(1, kMaxJoints); ++j)
        arm.joints.push_back(readJoint(joints.at(j), arm.motors.size()));
    if (node.has("tip"))
        arm.tip = node["tip"].vector();
    const Node frame = node["frame"];
    frame.object({"right", "up", "origin"});
    arm.deviceFromBase = readFrame(frame);
    if (frame.has("origin"))
        arm.origin = frame["origin"].vector();
    return arm;
}

DeviceLimits readLimits(const Node& node, const std::optional<ArmKinematics>& arm) {
    node.object({"maxForce", "maxForceRate", "recommendedStiffness", "maxStiffness", "staleAge",
                 "positionResolution", "apparentMass", "coulombFriction"});
    DeviceLimits limits;
    limits.maxForce = node["maxForce"].number(0, 100);
    limits.maxForceRate = limits.maxForce / 1e-3; // full force in a tick of 1 kHz
    if (arm)
        limits.positionResolution = resolutionOf(*arm);
    const auto optional = [&](const char* key, double least, double most, double& value) {
        if (node.has(key))
            value = node[key].number(least, most);
    };
    optional("maxForceRate", 0, 1e6, limits.maxForceRate);
    optional("maxStiffness", 1, 1e5, limits.maxStiffness);
    limits.recommendedStiffness = std::min(limits.recommendedStiffness, limits.maxStiffness);
    optional("recommendedStiffness", 1, limits.maxStiffness, limits.recommendedStiffness);
    optional("staleAge", 0.002, 0.5, limits.staleAge);
    optional("positionResolution", 1e-9, 0.1, limits.positionResolution);
    optional("apparentMass", 1e-3, 10, limits.apparentMass);
    optional("coulombFriction", 0, 10, limits.coulombFriction);
    return limits;
}

PadLimits readPad(const Node& node) {
    node.object({"reach", "rate"});
    return {.reach = node["reach"].number(0, 0.1), .rate = node["rate"].number(0, 100)};
}

DeviceProtocol readProtocol(const Node& node) {
    const std::string name = node.text();
    if (name == "woodenhaptics")
        return DeviceProtocol::WoodenHaptics;
    if (name == "touchstone-raw-hid")
        return DeviceProtocol::RawHid;
    node.fail("'" + name + "' is no protocol", "woodenhaptics or touchstone-raw-hid");
}

} // namespace

DeviceFile parseDeviceFile(std::string_view text, const std::string& name) {
    Json json;
    try {
        json = Json::parse(text, nullptr, true, true); // comments are allowed
    } catch (const Json::parse_error& error) {
        throw Error(name, "byte " + std::to_string(error.byte), "is not JSON",
                    "check commas and quotes there");
    } catch (const Json::exception&) { // 1e999
        throw Error(name, "", "has a number that is too large", "SI units: m, rad, N, A, s");
    }
    const Node root(json, name, "");
    root.object({"format", "version", "name", "protocol", "usb", "arm", "limits", "pad"});
    if (root["format"].text() != "touchstone-device")
        root["format"].fail("this is no device file", "\"format\": \"touchstone-device\"");
    if (root["version"].number(1, kUnlimited) != 1.0)
        root["version"].fail("of a newer Touchstone", "this one reads version 1");
    DeviceFile file;
    file.name = root["name"].text();
    file.protocol = readProtocol(root["protocol"]);
    file.usb = readUsb(root["usb"]);
    if (root.has("arm"))
        file.arm = readArm(root["arm"]);
    else if (file.protocol == DeviceProtocol::WoodenHaptics)
        root.fail("'arm' is missing", "this protocol sends encoder counts: say how the arm is built");
    if (file.protocol == DeviceProtocol::WoodenHaptics)
        for (size_t m = 3; m < file.arm->motors.size(); ++m)
            if (file.arm->motors[m].torqueConstant > 0.0)
                root["arm"]["motors"].at(m).fail("this protocol drives three motors",
                                                 "leave torqueConstant out of the gimbal's encoders");
    file.limits = readLimits(root["limits"], file.arm);
    if (root.has("pad") && file.protocol != DeviceProtocol::RawHid)
        root["pad"].fail("this protocol has no contact location", "leave it out");
    if (root.has("pad"))
        file.pad = readPad(root["pad"]);
    return file;
}

DeviceFile readDeviceFile(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    if (!in)
        throw Error(path.string(), "", "cannot be read", "check the name and the permissions");
    return parseDeviceFile(text.str(), path.string());
}

} // namespace touchstone

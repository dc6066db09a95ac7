#pragma once
// What is plugged in: the answer of `touchstone devices`. Reading the devices is not done here
// (hid_device.h).

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

/// What a known device gives.
enum class HidKind : uint8_t {
    SpaceMouse,   ///< 3Dconnexion six-axis input
    WoodenHaptics ///< Polhem and WoodenHaptics: encoders in, motor currents out
};

struct KnownHid {
    uint16_t vendor, product; ///< USB ids
    HidKind kind;
    const char* model;
};

/// Every device that we know, by its USB ids.
[[nodiscard]] std::span<const KnownHid> knownHids();
/// Null if unknown. 16c0:0486 is shared by all Teensy raw-HID boards: the ids alone do not prove a
/// WoodenHaptics.
[[nodiscard]] const KnownHid* knownHid(uint16_t vendor, uint16_t product);

/// May this user talk to it?
enum class HidAccess : uint8_t {
    ReadWrite,
    ReadOnly,
    None,   ///< the node exists, but its permissions forbid it: a udev rule helps
    Missing ///< no node: unplugged meanwhile, or /dev is not mounted here
};

struct HidNode {
    std::string path; ///< "/dev/hidraw0"
    uint16_t vendor = 0, product = 0;
    int interfaceNumber = -1;                      ///< of a USB device with several, else -1
    uint16_t usagePage = 0, usage = 0;             ///< of its first collection; 0: not told
    std::string manufacturer, productName, serial; ///< UTF-8, as the device gives them; may be empty
    const KnownHid* known = nullptr;
    HidAccess access = HidAccess::Missing;

    /// What a person calls it: the known model, else its own name, else its ids.
    [[nodiscard]] std::string name() const;
};

/// The order of the list: ours first, then by path, hidraw2 before hidraw10.
[[nodiscard]] bool listedBefore(const HidNode& a, const HidNode& b);

/// All raw HID nodes in that order, each once. Owner thread; opens nothing, so it disturbs
/// nobody. An empty list is an answer: nothing is plugged in, or the machine has no hidraw (a container).
[[nodiscard]] std::vector<HidNode> listHidNodes();

/// The permissions of a node for this process.
[[nodiscard]] HidAccess hidAccess(const std::string& path);

/// Whether it may be the axes of a SpaceMouse: the large models are keyboards, too, and say so in their
/// usage.
[[nodiscard]] bool hasAxes(const HidNode& node);

/// What to do about `access`, or empty if nothing needs to be done.
[[nodiscard]] std::string hidRemedy(const HidNode& device);

} // namespace touchstone

#pragma once
// The plugged-in HID devices: `touchstone devices`. hid_device.h reads them.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

/// The kind of data that a known device reports.
enum class HidKind : uint8_t {
    SpaceMouse,   ///< 3Dconnexion six-axis input
    WoodenHaptics ///< Polhem and WoodenHaptics: encoders in, motor currents out
};

struct KnownHid {
    uint16_t vendor, product; ///< USB ids
    HidKind kind;
    const char* model;
};

/// All known devices, by USB ids.
[[nodiscard]] std::span<const KnownHid> knownHids();
/// Null if unknown. 16c0:0486 is shared by all Teensy raw-HID boards: the ids alone do not prove a
/// WoodenHaptics.
[[nodiscard]] const KnownHid* knownHid(uint16_t vendor, uint16_t product);

/// Access rights of this user.
enum class HidAccess : uint8_t {
    ReadWrite,
    ReadOnly,
    None,   ///< the node exists without permission: a udev rule helps
    Missing ///< no node: unplugged meanwhile, or /dev is not mounted here
};

struct HidNode {
    std::string path; ///< "/dev/hidraw0"
    uint16_t vendor = 0, product = 0;
    int interfaceNumber = -1;                      ///< of a USB device with several, else -1
    uint16_t usagePage = 0, usage = 0;             ///< of its first collection; 0: not given
    std::string manufacturer, productName, serial; ///< UTF-8, as the device gives them; may be empty
    const KnownHid* known = nullptr;
    HidAccess access = HidAccess::Missing;

    /// Name for the user: the known model, else the device's own name, else its ids.
    [[nodiscard]] std::string name() const;
};

/// The order of the list: known devices first, then by path, hidraw2 before hidraw10.
[[nodiscard]] bool listedBefore(const HidNode& a, const HidNode& b);

/// All raw HID nodes in that order, each once. Owner thread; opens no node, so it disturbs no other reader.
/// An empty list is valid: nothing is plugged in, or the machine has no hidraw (a container).
[[nodiscard]] std::vector<HidNode> listHidNodes();

/// This process's permissions for a node.
[[nodiscard]] HidAccess hidAccess(const std::string& path);

/// Whether the node may carry the axes of a SpaceMouse: the large models are also keyboards and declare that
/// in their usage.
[[nodiscard]] bool hasAxes(const HidNode& node);

/// The remedy for `access`; empty if none is needed.
[[nodiscard]] std::string hidRemedy(const HidNode& device);

} // namespace touchstone

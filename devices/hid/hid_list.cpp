#include "devices/hid/hid_list.h"

#include "devices/hid/hid_text.h"
#include "devices/hid/hidapi_lock.h"

#include <hidapi/hidapi.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <string_view>
#include <tuple>

namespace touchstone {

namespace {

constexpr uint16_t kLogitech = 0x046d, k3Dconnexion = 0x256f, kTeensy = 0x16c0;

constexpr std::array<KnownHid, 23> kKnown{{
    {kLogitech, 0xc603, HidKind::SpaceMouse, "SpaceMouse Plus"},
    {kLogitech, 0xc605, HidKind::SpaceMouse, "CadMan"},
    {kLogitech, 0xc606, HidKind::SpaceMouse, "SpaceMouse Classic"},
    {kLogitech, 0xc621, HidKind::SpaceMouse, "SpaceBall 5000"},
    {kLogitech, 0xc623, HidKind::SpaceMouse, "SpaceTraveler"},
    {kLogitech, 0xc625, HidKind::SpaceMouse, "SpacePilot"},
    {kLogitech, 0xc626, HidKind::SpaceMouse, "SpaceNavigator"},
    {kLogitech, 0xc627, HidKind::SpaceMouse, "SpaceExplorer"},
    {kLogitech, 0xc628, HidKind::SpaceMouse, "SpaceNavigator for Notebooks"},
    {kLogitech, 0xc629, HidKind::SpaceMouse, "SpacePilot Pro"},
    {kLogitech, 0xc62b, HidKind::SpaceMouse, "SpaceMouse Pro"},
    {kLogitech, 0xc640, HidKind::SpaceMouse, "nuLOOQ"},
    {k3Dconnexion, 0xc62e, HidKind::SpaceMouse, "SpaceMouse Wireless (cable)"},
    {k3Dconnexion, 0xc62f, HidKind::SpaceMouse, "SpaceMouse Wireless (receiver)"},
    {k3Dconnexion, 0xc631, HidKind::SpaceMouse, "SpaceMouse Pro Wireless (cable)"},
    {k3Dconnexion, 0xc632, HidKind::SpaceMouse, "SpaceMouse Pro Wireless (receiver)"},
    {k3Dconnexion, 0xc633, HidKind::SpaceMouse, "SpaceMouse Enterprise"},
    {k3Dconnexion, 0xc635, HidKind::SpaceMouse, "SpaceMouse Compact"},
    {k3Dconnexion, 0xc636, HidKind::SpaceMouse, "SpaceMouse Module"},
    {k3Dconnexion, 0xc638, HidKind::SpaceMouse, "SpaceMouse Pro Wireless"},
    {k3Dconnexion, 0xc63a, HidKind::SpaceMouse, "SpaceMouse Wireless"},
    {k3Dconnexion, 0xc652, HidKind::SpaceMouse, "Universal Receiver"},
    {kTeensy, 0x0486, HidKind::WoodenHaptics, "Polhem or WoodenHaptics (Teensy raw HID)"},
}};

std::string ids(uint16_t vendor, uint16_t product) {
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), "%04x:%04x", vendor, product);
    return text.data();
}

} // namespace

std::string utf8(const wchar_t* text) {
    std::string result;
    for (; text != nullptr && *text != L'\0'; ++text) {
        const auto c = static_cast<uint32_t>(*text);
        const auto put = [&](uint32_t byte) { result.push_back(static_cast<char>(byte & 0xFF)); };
        if (c < 0x80) {
            put(c);
        } else if (c < 0x800) {
            put(0xC0 | (c >> 6));
            put(0x80 | (c & 0x3F));
        } else if (c < 0x10000) {
            put(0xE0 | (c >> 12));
            put(0x80 | ((c >> 6) & 0x3F));
            put(0x80 | (c & 0x3F));
        } else if (c < 0x110000) {
            put(0xF0 | (c >> 18));
            put(0x80 | ((c >> 12) & 0x3F));
            put(0x80 | ((c >> 6) & 0x3F));
            put(0x80 | (c & 0x3F));
        }
    }
    return result;
}

std::span<const KnownHid> knownHids() {
    return kKnown;
}

const KnownHid* knownHid(uint16_t vendor, uint16_t product) {
    for (const KnownHid& known : kKnown)
        if (known.vendor == vendor && known.product == product)
            return &known;
    return nullptr;
}

std::string HidNode::name() const {
    if (known != nullptr)
        return known->model;
    if (!productName.empty())
        return productName;
    return "HID device " + ids(vendor, product);
}

bool hasAxes(const HidNode& node) {
    constexpr uint16_t kGenericDesktop = 1, kMultiAxis = 8;
    return node.usagePage == 0 || (node.usagePage == kGenericDesktop && node.usage == kMultiAxis);
}

HidAccess hidAccess(const std::string& path) {
    if (access(path.c_str(), R_OK | W_OK) == 0)
        return HidAccess::ReadWrite;
    if (errno == ENOENT || errno == ENOTDIR)
        return HidAccess::Missing;
    return access(path.c_str(), R_OK) == 0 ? HidAccess::ReadOnly : HidAccess::None;
}

std::string hidRemedy(const HidNode& device) {
    switch (device.access) {
    case HidAccess::ReadWrite:
        return {};
    case HidAccess::Missing:
        return "plug it in again; in a container, pass " + device.path + " through";
    case HidAccess::ReadOnly:
    case HidAccess::None:
        break;
    }
    const std::string both = ids(device.vendor, device.product);
    return "allow it with a udev rule: echo 'KERNEL==\"hidraw*\", ATTRS{idVendor}==\"" + both.substr(0, 4) +
           "\", ATTRS{idProduct}==\"" + both.substr(5) +
           "\", TAG+=\"uaccess\"' | sudo tee -a /etc/udev/rules.d/71-touchstone-local.rules, then plug it in "
           "again";
}

bool listedBefore(const HidNode& a, const HidNode& b) {
    const auto rank = [](const HidNode& node) {
        return std::tuple(node.known == nullptr, node.path.size(), std::string_view(node.path));
    };
    return rank(a) < rank(b);
}

std::vector<HidNode> listHidNodes() {
    std::vector<HidNode> devices;
    const std::lock_guard lock(hidapiMutex());
    if (hid_init() != 0)
        return devices;
    const std::unique_ptr<hid_device_info, void (*)(hid_device_info*)> all(hid_enumerate(0, 0),
                                                                           hid_free_enumeration);
    for (const hid_device_info* info = all.get(); info != nullptr; info = info->next) {
        if (info->path == nullptr)
            continue;
        // hidapi lists a node once for each of its top-level usages.
        const auto same = [&](const HidNode& device) { return device.path == info->path; };
        if (std::any_of(devices.begin(), devices.end(), same))
            continue;
        devices.push_back({info->path, info->vendor_id, info->product_id, info->interface_number,
                           info->usage_page, info->usage, utf8(info->manufacturer_string),
                           utf8(info->product_string), utf8(info->serial_number),
                           knownHid(info->vendor_id, info->product_id), hidAccess(info->path)});
    }
    std::sort(devices.begin(), devices.end(), listedBefore);
    return devices;
}

} // namespace touchstone

#include "devices/choice/device_choice.h"

#include "devices/external/external_device.h"
#include "devices/hid/hid_device.h"
#include "engine/core/error.h"
#include "engine/process/helper_program.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <utility>
#include <variant>

namespace touchstone {

namespace {

std::string lowered(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

bool contains(const std::string& name, const std::string& part) {
    return lowered(name).find(lowered(part)) != std::string::npos;
}

void readFolder(const std::filesystem::path& folder, std::vector<DeviceFile>& files) {
    std::error_code error;
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error))
        if (entry.path().extension() == ".json")
            paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    for (const auto& path : paths)
        files.push_back(readDeviceFile(path));
}

bool describes(const DeviceFile& file, const HidNode& node) {
    return file.usb.vendor == node.vendor && file.usb.product == node.product &&
           (!file.usb.interfaceNumber || *file.usb.interfaceNumber == node.interfaceNumber) &&
           (file.usb.serial.empty() || file.usb.serial == node.serial);
}

const DeviceFile* fileOf(const HidNode& node, std::span<const DeviceFile> files) {
    const auto found = std::find_if(files.begin(), files.end(),
                                    [&](const DeviceFile& file) { return describes(file, node); });
    return found != files.end() ? &*found : nullptr;
}

bool isSpaceMouse(const HidNode& node) {
    return node.known != nullptr && node.known->kind == HidKind::SpaceMouse;
}

/// All Teensy boards with raw HID share the ids of a WoodenHaptics; only the name tells them apart.
bool isDoubtful(const HidNode& node) {
    return node.known != nullptr && node.known->kind == HidKind::WoodenHaptics &&
           !contains(node.productName, "polhem") && !contains(node.productName, "wooden");
}

/// What a choice selects: nothing, another program at a port, a device.
using Selected = std::variant<std::monostate, uint16_t, HidRecipe>;

uint16_t portOf(const std::string& choice) {
    uint16_t port = kExternalPort;
    if (choice != "udp") {
        const std::string given = choice.substr(4);
        const auto [end, error] = std::from_chars(given.data(), given.data() + given.size(), port);
        if (error != std::errc{} || end != given.data() + given.size() || port == 0)
            throw Error(
                "--device", choice, "'" + given + "' is no port",
                "udp:PORT, 1..65535; it listens on this machine only, so there is no address to give");
    }
    return port;
}

HidRecipe recipeAt(const HidNode& node, std::span<const DeviceFile> files) {
    if (isSpaceMouse(node)) {
        HidRecipe recipe = spaceMouseRecipe(node);
        if (hasAxes(node)) // else another node of the same device carries the axes
            recipe.identity = identityOf(node);
        return recipe;
    }
    if (const DeviceFile* file = fileOf(node, files)) {
        HidRecipe recipe = recipeOf(*file, node.path);
        recipe.identity = identityOf(node);
        return recipe;
    }
    throw Error("--device", node.path, node.name() + " is no device that is known here",
                "describe it in a device file (docs/devices.md) and give that: --device FILE.json");
}

/// "/dev/hidraw3 (SpaceMouse)", ...
std::vector<std::string> pluggedIn(std::span<const DeviceOffer> offers) {
    std::vector<std::string> names;
    for (const DeviceOffer& offer : offers)
        names.push_back(offer.choice + " (" + offer.name + ")");
    return names;
}

std::string joined(std::span<const std::string> names) {
    std::string all;
    for (const std::string& name : names)
        all += (all.empty() ? "" : ", ") + name;
    return all;
}

/// The remedy for a choice that is none.
std::string allChoices(const std::string& builtIn, std::span<const HidNode> nodes,
                       std::span<const DeviceFile> files) {
    std::vector<std::string> names = pluggedIn(deviceOffers(nodes, files));
    const bool none = names.empty();
    if (!builtIn.empty())
        names.insert(names.begin(), builtIn);
    names.emplace_back("udp[:PORT] (another program)");
    for (const DeviceFile& file : files)
        names.push_back(file.name + " (described)");
    return "choose one of: " + joined(names) + (none ? "; nothing known is plugged in" : "") +
           "; `touchstone devices` tells more";
}

HidRecipe recipeNamed(const std::string& choice, const std::string& builtIn, std::span<const HidNode> nodes,
                      std::span<const DeviceFile> files) {
    std::vector<DeviceOffer> found;
    for (DeviceOffer& offer : deviceOffers(nodes, files))
        if (contains(offer.name, choice))
            found.push_back(std::move(offer));
    if (found.size() > 1)
        throw Error("--device", choice, "is the name of several", "choose one: " + joined(pluggedIn(found)));
    if (found.size() == 1)
        return recipeAt(*std::find_if(nodes.begin(), nodes.end(),
                                      [&](const HidNode& node) { return node.path == found[0].choice; }),
                        files);
    for (const DeviceFile& file : files)
        if (contains(file.name, choice))
            return recipeOf(file);
    throw Error("--device", choice, "nothing of that name is plugged in or described",
                allChoices(builtIn, nodes, files));
}

Selected selected(const std::string& choice, const std::string& builtIn) {
    if (choice == "udp" || choice.starts_with("udp:"))
        return portOf(choice);
    if (choice.ends_with(".json"))
        return recipeOf(readDeviceFile(choice));
    const std::vector<HidNode> nodes = listHidNodes();
    const std::vector<DeviceFile> files = deviceFiles();
    if (choice.starts_with("/")) {
        for (const HidNode& node : nodes)
            if (node.path == choice)
                return recipeAt(node, files);
        throw Error("--device", choice, "there is no such HID node", allChoices(builtIn, nodes, files));
    }
    if (choice != "auto")
        return recipeNamed(choice, builtIn, nodes, files);
    for (const bool driven : {true, false})
        for (const DeviceOffer& offer : deviceOffers(nodes, files))
            if (offer.driven == driven && offer.remedy.empty() && !offer.doubtful)
                return selected(offer.choice, builtIn);
    return std::monostate();
}

} // namespace

std::vector<DeviceFile> deviceFiles() {
    std::vector<DeviceFile> files;
    if (const char* folder = std::getenv("TOUCHSTONE_DEVICES"))
        readFolder(folder, files);
    readFolder(dataFolder("devices", TOUCHSTONE_DEVICE_FILES), files);
    return files;
}

std::vector<DeviceOffer> deviceOffers(std::span<const HidNode> nodes, std::span<const DeviceFile> files) {
    std::vector<DeviceOffer> offers;
    for (const HidNode& node : nodes) {
        const DeviceFile* file = fileOf(node, files);
        if (isSpaceMouse(node) && hasAxes(node))
            offers.push_back({node.path, node.name(), hidRemedy(node), false, false});
        else if (file != nullptr)
            offers.push_back({node.path, file->name, hidRemedy(node), true, isDoubtful(node)});
    }
    return offers;
}

std::unique_ptr<LinkedDevice> openDevice(const std::string& choice, const std::string& builtIn) {
    Selected device = selected(choice, builtIn);
    if (const uint16_t* port = std::get_if<uint16_t>(&device))
        return std::make_unique<ExternalDevice>(*port);
    if (HidRecipe* recipe = std::get_if<HidRecipe>(&device))
        return std::make_unique<HidDevice>(std::move(*recipe));
    return nullptr;
}

void requireDevice(const std::string& choice, const std::string& builtIn) {
    (void)selected(choice, builtIn);
}

} // namespace touchstone

// Lists the plugged-in devices and tests one device.

#include "devices/choice/device_choice.h"
#include "engine/core/error.h"
#include "engine/core/output_file.h"
#include "workbench/commands/device_test.h"
#include "workbench/guards/interrupt.h"
#include "workbench/options/commands.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>

namespace touchstone {

namespace {

const char* accessName(HidAccess access) {
    switch (access) {
    case HidAccess::ReadWrite:
        return "ready";
    case HidAccess::ReadOnly:
        return "read only";
    case HidAccess::None:
        return "no permission";
    case HidAccess::Missing:
        return "missing";
    }
    return "";
}

/// Remarks on a node besides its name and access.
std::string remark(const HidNode& node, const std::vector<DeviceOffer>& offers) {
    const auto offer = std::find_if(offers.begin(), offers.end(), [&](const DeviceOffer& candidate) {
        return candidate.choice == node.path;
    });
    if (offer == offers.end())
        return node.known != nullptr ? "" : "  (not a device that Touchstone knows)";
    const std::string use =
        "  --device " + node.path + (offer->driven ? "  (gives force)" : "  (input only)");
    return offer->doubtful ? use + "  (many boards have these ids: choose it only if it is one)" : use;
}

void listDevices() {
    std::printf("built in\n");
    std::printf("  mouse            position from the window, no force\n");
    std::printf("  simulated hand   strokes the model on a path of its own (run, --hand simulated)\n");
    std::printf("  udp              another program on this machine (--device udp), see docs/devices.md\n");
    const std::vector<HidNode> nodes = listHidNodes();
    const std::vector<DeviceFile> files = deviceFiles();
    const std::vector<DeviceOffer> offers = deviceOffers(nodes, files);
    std::printf("plugged in%s\n", nodes.empty() ? ": no HID device" : "");
    for (const HidNode& node : nodes) {
        std::printf("  %s  %04x:%04x  %s  %s%s\n", node.path.c_str(), node.vendor, node.product,
                    node.name().c_str(), accessName(node.access), remark(node, offers).c_str());
        const std::string remedy = hidRemedy(node);
        if (!remedy.empty())
            std::printf("    remedy: %s\n", remedy.c_str());
    }
    std::printf("described, to be chosen by name before they are plugged in\n");
    for (const DeviceFile& file : files)
        std::printf("  %-16s %04x:%04x  %.1f N at most\n", file.name.c_str(), file.usb.vendor,
                    file.usb.product, file.limits.maxForce);
}

} // namespace

int devicesCommand(const DevicesOptions& options) {
    if (options.test.empty()) {
        listDevices();
        return 0;
    }
    catchInterrupts();
    std::optional<OutputFile> report;
    if (!options.json.empty())
        report.emplace(options.json);
    const std::unique_ptr<LinkedDevice> device = openDevice(options.test);
    if (device == nullptr)
        throw Error("--test", options.test, "nothing is plugged in that may be used",
                    "touchstone devices lists what is there and what to do about it");
    const DeviceTestFigures figures = testDevice(*device, options.seconds, options.force);
    std::printf("%s", describe(figures, *device).c_str());
    if (report) {
        report->write(
            toJson(figures, *device).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
            "\n");
        report->commit();
    }
    return figures.validTicks > 0 ? 0 : 1;
}

} // namespace touchstone

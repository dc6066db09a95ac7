#include "devices/hid/hid_list.h"
#include "workbench/commands.h"

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

} // namespace

int devicesCommand() {
    std::printf("built in\n");
    std::printf("  mouse            position from the window, no force\n");
    std::printf(
        "  simulated hand   strokes the model on a path of its own (run --headless, --hand simulated)\n");
    const std::vector<HidNode> devices = listHidNodes();
    std::printf("plugged in%s\n", devices.empty() ? ": no HID device" : "");
    for (const HidNode& device : devices) {
        std::printf("  %s  %04x:%04x  %s  %s%s\n", device.path.c_str(), device.vendor, device.product,
                    device.name().c_str(), accessName(device.access),
                    device.known != nullptr ? "  (known)" : "");
        const std::string remedy = hidRemedy(device);
        if (!remedy.empty())
            std::printf("    remedy: %s\n", remedy.c_str());
    }
    return 0;
}

} // namespace touchstone

#pragma once
// From what a person calls a device (--device, the panel) to the device.

#include "devices/hid/device_file.h"
#include "devices/hid/hid_list.h"
#include "devices/link/linked_device.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

/// Device files that come with the program, and those of the folder that TOUCHSTONE_DEVICES names, which are
/// asked first. A file that cannot be read is an Error.
[[nodiscard]] std::vector<DeviceFile> deviceFiles();

/// What is plugged in and can be used, or could be if it were allowed.
struct DeviceOffer {
    std::string choice; ///< what chooses it: "/dev/hidraw3"
    std::string name;
    std::string remedy;  ///< what to do before it can be used; empty: nothing
    bool driven = false; ///< takes forces
    /// Nothing but the USB ids says that it is this device, and others have the same: only a person may
    /// choose it.
    bool doubtful = false;
};
[[nodiscard]] std::vector<DeviceOffer> deviceOffers(std::span<const HidNode> nodes,
                                                    std::span<const DeviceFile> files);

/// Opens what `choice` names:
/// - "udp" or "udp:PORT": another program;
/// - "/dev/hidraw3": that node;
/// - a file that ends in .json: what it describes, plugged in now or later;
/// - "auto": the first that is plugged in, may be used and is what it seems, driven ones first; null if none
/// is;
/// - else a part of the name of what is plugged in or of what a device file describes.
/// Throws Error for what names nothing, or several, or a machine other than this one. Whether the device is
/// there and may be used is in its report().
[[nodiscard]] std::unique_ptr<LinkedDevice> openDevice(const std::string& choice);

} // namespace touchstone

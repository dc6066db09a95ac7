#pragma once
// From a device name given by the user (--device, the panel) to the device.

#include "devices/hid/device_file.h"
#include "devices/hid/hid_list.h"
#include "devices/link/linked_device.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

/// The device files of the folder named by TOUCHSTONE_DEVICES, which take precedence, and those that come
/// with the program. An unreadable file is returned as an Error.
[[nodiscard]] std::vector<DeviceFile> deviceFiles();

/// A device that is plugged in and usable, or usable once `remedy` is applied.
struct DeviceOffer {
    std::string choice; ///< the choice that selects it: "/dev/hidraw3"
    std::string name;
    std::string remedy;  ///< what to do before it can be used; empty: nothing
    bool driven = false; ///< accepts forces
    /// Identified by USB ids alone, which other devices share: never chosen automatically.
    bool doubtful = false;
};
[[nodiscard]] std::vector<DeviceOffer> deviceOffers(std::span<const HidNode> nodes,
                                                    std::span<const DeviceFile> files);

/// Opens the device that `choice` names:
/// - "udp" or "udp:PORT": another program;
/// - "/dev/hidraw3": that node;
/// - a path that ends in .json: the device that the file describes, plugged in now or later;
/// - "auto": the first device that is plugged in, accessible and not doubtful, with force output first; null
///   if there is none;
/// - else a part of the name of a plugged-in device or of one that a device file describes.
/// Throws Error if `choice` matches nothing or several devices, or names another machine; the remedy lists
/// what may be chosen, with `builtIn` ("hand (the simulated one)"), which the caller knows, before the rest.
/// report() tells whether the device is present and accessible.
[[nodiscard]] std::unique_ptr<LinkedDevice> openDevice(const std::string& choice,
                                                       const std::string& builtIn = {});
/// Throws as openDevice does, without opening anything.
void requireDevice(const std::string& choice, const std::string& builtIn);

} // namespace touchstone

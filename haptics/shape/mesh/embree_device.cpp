#include "haptics/shape/mesh/embree_device.h"

#include "engine/core/error.h"
#include "haptics/shape/mesh/embree.h"

#include <memory>

namespace touchstone {

RTCDeviceTy* embreeDevice() {
    static const std::shared_ptr<RTCDeviceTy> device = [] {
        RTCDevice made = rtcNewDevice("threads=2");
        if (made == nullptr)
            throw Error("Embree", "", "no device could be made", "check that Debian's libembree is intact");
        return std::shared_ptr<RTCDeviceTy>(made, rtcReleaseDevice);
    }();
    return device.get();
}

} // namespace touchstone

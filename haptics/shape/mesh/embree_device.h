#pragma once

struct RTCDeviceTy;

namespace touchstone {

/// The process's Embree device, created at the first call. Errors are read after each build. Throws Error
/// when there is none. Not for the servo thread.
[[nodiscard]] RTCDeviceTy* embreeDevice();

} // namespace touchstone

#pragma once

namespace touchstone {

/// s without a command after which a device considers the servo dead and sets zero force; also the longest
/// tick that the safety stage counts. As long as DeviceLimits::staleAge and for the same reason.
inline constexpr double kServoSilence = 0.02;

} // namespace touchstone

#pragma once

namespace touchstone {

/// s without an order after which a device takes the servo for dead and is given zero force; and the longest
/// tick that the safety stage counts as one. As long as DeviceLimits::staleAge and for the same reason.
inline constexpr double kServoSilence = 0.02;

} // namespace touchstone

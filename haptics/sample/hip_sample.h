#pragma once
// Stage 1: the position and velocity of the hand.

#include "engine/device_io/device_io.h"
#include "haptics/state/device_state.h"

namespace touchstone {

/// Cut-off of the velocity's low-pass, Hz. Lower is smoother under encoder noise but damps late.
inline constexpr double kVelocityCutoff = 80.0;
/// Upper bound of a hand's speed, m/s of the device: a faster sample is reported as a jump, and swept
/// nevertheless.
inline constexpr double kFastestHand = 20.0;

/// Transforms a sample (device frame) into state.hip and state.velocity (workspace). False when it is
/// unusable: position and velocity are then unchanged, and the time without a sample grows. Sets InputInvalid
/// and Teleported.
[[nodiscard]] bool takeSample(const DeviceSample& sample, double dt, DeviceState& state,
                              uint32_t& flags) noexcept;

} // namespace touchstone

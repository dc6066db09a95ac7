#pragma once
// The state that touch carries from one tick to the next, in so few bytes that the servo can publish it. A
// replay may begin there, also in the middle of a run and behind a gap.

#include "haptics/scene/haptic_scene.h"
#include "haptics/state/device_state.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace touchstone {

/// The state of one device before a tick. A DeviceState holds a megabyte, nearly all of it triangles gathered
/// near the proxy. They are not saved: at a checkpoint the servo drops them and the tick gathers again, which
/// it must be able to do at any time; the rest is little more than a kilobyte.
struct TouchCheckpoint {
    static constexpr size_t kCapacity = 1536;

    uint64_t tick = 0;  ///< the next tick
    uint32_t hand = 0;  ///< TickRecord::hand
    uint32_t scene = 0; ///< TickRecord::scene of that tick
    /// s, animationTime of the preceding tick in the same scene, at which moving objects had their previous
    /// poses; NaN where there was none.
    double previousTime = std::numeric_limits<double>::quiet_NaN();
    uint32_t size = 0;
    std::array<std::byte, kCapacity> bytes{};

    [[nodiscard]] std::span<const std::byte> state() const { return {bytes.data(), size}; }
};

/// Servo thread. Fills `size` and `bytes` and drops the gathered triangles from `state`, so that it equals
/// what `restoreCheckpoint` makes of the bytes. No allocation.
void takeCheckpoint(DeviceState& state, TouchCheckpoint& checkpoint) noexcept;

/// Restores `state`. False, with `state` unchanged, where the bytes are no touch of this scene: they are of
/// another version, or name an object or a triangle that does not exist. `scene` null: nothing to touch.
[[nodiscard]] bool restoreCheckpoint(std::span<const std::byte> bytes, const HapticScene* scene,
                                     DeviceState& state) noexcept;

/// Bytes of a checkpoint of this version.
[[nodiscard]] size_t checkpointSize() noexcept;

} // namespace touchstone

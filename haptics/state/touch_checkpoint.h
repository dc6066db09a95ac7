#pragma once
// What touch carries from one tick to the next, in so few bytes that the servo can give it away: where a
// replay may begin, also in the middle of a run and behind a gap.

#include "haptics/scene/haptic_scene.h"
#include "haptics/state/device_state.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace touchstone {

/// The state of one device before a tick. A DeviceState holds a megabyte, nearly all of it triangles gathered
/// near the proxy. They are not saved: at a checkpoint the servo forgets them and the tick gathers anew,
/// which it must at any time anyway; what is left is smaller than a kilobyte.
struct TouchCheckpoint {
    static constexpr size_t kCapacity = 1024;

    uint64_t tick = 0;  ///< the tick that comes next
    uint32_t scene = 0; ///< TickRecord::scene of that tick
    /// s, TickRecord::time of the tick before in the same scene, from which objects that move have come; NaN
    /// where there was none.
    double previousTime = std::numeric_limits<double>::quiet_NaN();
    uint32_t size = 0;
    std::array<std::byte, kCapacity> bytes{};

    [[nodiscard]] std::span<const std::byte> state() const { return {bytes.data(), size}; }
};

/// Servo thread. Fills `size` and `bytes` and drops the gathered triangles from `state`, so that it is now
/// what `restoreCheckpoint` makes of the bytes. No allocation.
void takeCheckpoint(DeviceState& state, TouchCheckpoint& checkpoint) noexcept;

/// Makes `state` what it was. False, and unchanged, where the bytes are not those of a touch of this scene:
/// they come from another version, or name an object or a triangle that is not there. `scene` null: nothing
/// to touch.
[[nodiscard]] bool restoreCheckpoint(std::span<const std::byte> bytes, const HapticScene* scene,
                                     DeviceState& state) noexcept;

/// Bytes of a checkpoint made by this version.
[[nodiscard]] size_t checkpointSize() noexcept;

} // namespace touchstone

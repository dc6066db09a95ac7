#pragma once
// One hash for the result of each stage of a tick.

#include "haptics/tick/haptic_step.h"
#include "haptics/tick/stage_trace.h"

#include <array>
#include <cstdint>

namespace touchstone {

/// Index = Stage. Equal bits give equal hashes; different bits collide with a probability of one in four
/// thousand million.
using StageHashes = std::array<uint32_t, kStageCount>;

/// Hashes each stage's output (docs/recording.md lists it). Reader's thread; takes a tenth of a microsecond.
[[nodiscard]] StageHashes stageHashes(const StageTrace& trace, const HapticOutput& output) noexcept;

} // namespace touchstone

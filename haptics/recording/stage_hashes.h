#pragma once
// One number for what each stage of a tick came to.

#include "haptics/tick/haptic_step.h"
#include "haptics/tick/stage_trace.h"

#include <array>
#include <cstdint>

namespace touchstone {

/// Index = Stage. Equal bits give equal hashes; different ones differ but for one in four thousand million.
using StageHashes = std::array<uint32_t, kStageCount>;

/// Each stage by what it wrote (docs/recording.md lists it). Reader's thread; takes a tenth of a microsecond.
[[nodiscard]] StageHashes stageHashes(const StageTrace& trace, const HapticOutput& output) noexcept;

} // namespace touchstone

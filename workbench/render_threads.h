#pragma once

namespace touchstone {

/// Leaves a core to the servo: tells the software rasteriser (llvmpipe) to use one thread less than there are
/// cores, unless LP_NUM_THREADS says otherwise already. Before the Vulkan device is made; real GPUs ignore
/// it.
void leaveOneCoreToTheServo();

} // namespace touchstone

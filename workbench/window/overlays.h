#pragma once

#include "haptics/haptic_settings.h"
#include "haptics/servo/servo_loop.h"
#include "renderer/overlay.h"
#include "renderer/view.h"

namespace touchstone {

/// What a tick looks like: HIP, proxy, force arrow, active planes, stiction point. Main thread.
void drawTick(const TickRecord& record, const HapticSettings& settings, Overlay& overlay);

/// The ball that is drawn for the proxy, as what casts a shadow.
[[nodiscard]] ProbeShadow probeShadow(const TickRecord& record, const HapticSettings& settings);

} // namespace touchstone

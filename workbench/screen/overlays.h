#pragma once

#include "haptics/scene/haptic_scene.h"
#include "haptics/servo/servo_loop.h"
#include "haptics/settings/haptic_settings.h"
#include "renderer/overlay.h"
#include "renderer/view.h"
#include "workbench/screen/view_options.h"

namespace touchstone {

struct TickLook {
    ShownOverlays shown;
    double frictionCoefficient =
        0.0;            ///< of the touched material: tangent of the cone's half angle; 0: no cone
    double scale = 1.0; ///< of all sizes but the proxy's own radius; a magnifier wants less than 1
};

/// What a tick looks like: HIP, proxy, force arrow, active planes, stiction point with the friction cone (a
/// force inside it sticks), felt normal. Main thread.
void drawTick(const TickRecord& record, const HapticSettings& settings, const TickLook& look,
              Overlay& overlay);

/// The ball that is drawn for the proxy, as what casts a shadow.
[[nodiscard]] ProbeShadow probeShadow(const TickRecord& record, const HapticSettings& settings);

/// The static coefficient where the tick touches: the session's, else the material's, without its map or
/// vertices; 0 where no friction is felt.
[[nodiscard]] double frictionCoefficientAt(const TickRecord& record, const HapticSettings& settings,
                                           const Scene& scene, const HapticScene& haptic);

} // namespace touchstone

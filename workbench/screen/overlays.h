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
    double scale = 1.0; ///< of all sizes except the proxy's own radius; less than 1 in a magnifier
};

/// Overlays of a tick: HIP, proxy, force arrow (grey where it is not sent to the device), active planes,
/// stiction point with the friction cone (a force inside it sticks), felt normal. Main thread.
void drawTick(const TickRecord& record, const HapticSettings& settings, const TickLook& look,
              Overlay& overlay);

/// The proxy's drawn ball as a shadow caster.
[[nodiscard]] ProbeShadow probeShadow(const TickRecord& record, const HapticSettings& settings);

/// The static friction coefficient at the touched point: the session's, else the material's, without its map
/// or vertices; 0 without friction.
[[nodiscard]] double frictionCoefficientAt(const TickRecord& record, const HapticSettings& settings,
                                           const Scene& scene, const HapticScene& haptic);

} // namespace touchstone

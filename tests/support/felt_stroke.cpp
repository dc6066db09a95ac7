#include "tests/support/felt_stroke.h"

#include "haptics/tick/stepped_hand.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace touchstone::test {

FeltStroke feel(const HapticScene& scene, const StrokePath& path, ScenePtr source, int periods) {
    constexpr double kTick = 0.001; // s
    HapticSettings settings;        // the bare surface: what the hand does, not what the material makes of it
    settings.texture = TextureMode::Off;
    settings.friction = FrictionMode::Off;
    settings.forceShading = ShadingMode::Off;
    settings.deformation = false;
    SteppedHand hand(scene, source);
    const HapticOutput& output = hand.output;
    FeltStroke felt;
    felt.ticks = static_cast<int>(periods * path.period() / kTick);
    for (int tick = 0; tick < felt.ticks; ++tick) {
        const double time = tick * kTick;
        (void)hand.tick(settings,
                        sampleAt(source != nullptr ? path.positionIn(time, time) : path.position(time)), time,
                        kTick);
        felt.contact += output.contacts > 0;
        felt.began = felt.began || (tick == 0 && output.contacts > 0);
        if (!felt.inside && has(output.flags, TickFlag::StartedInside)) {
            felt.inside = true;
            felt.insideAt = time;
        }
        if (output.penetration > felt.deepest) {
            felt.deepest = output.penetration;
            felt.deepestAt = time;
        }
        const glm::dvec3 velocity = path.velocity(time);
        felt.fastest = std::max(felt.fastest, glm::length(velocity));
        if (output.contacts > 0)
            felt.fastestInTouch = std::max(felt.fastestInTouch, glm::length(velocity));
        felt.jerkiest = std::max(felt.jerkiest, glm::distance(path.velocity(time + 1e-4), velocity) / 1e-4);
    }
    return felt;
}

} // namespace touchstone::test

#pragma once
// One case of effects under random strokes: where the proxy ends in every tick against an oracle in long
// double, and whether the command keeps its limits.

#include "tests/property/effects/effect_case.h"
#include "tests/property/effects/effect_world.h"

#include <span>
#include <string>
#include <vector>

namespace touchstone::test {

struct EffectFigures {
    std::string name;
    int ticks = 0;                         ///< with the proxy placed
    int contact = 0;                       ///< of these, in contact
    int budget = 0;                        ///< contact ticks that the budget ended
    int exempt = 0;                        ///< contact ticks between closing jaws or among too many triangles
    int notConverged = 0;                  ///< contact ticks in which shading gave up
    int off = 0;                           ///< contact ticks that end off the surface, beyond the certificate
    int late = 0;                          ///< those that the budget ended, off the surface: not in `off`
    int left = 0;                          ///< ticks without contact though the proxy is not at the HIP
    double worst = 0.0;                    ///< m, of `off` and `left`
    double latest = 0.0;                   ///< m, of `late`
    double inside = 0.0;                   ///< m, most that the proxy was nearer than its radius; two-sided
    int limits = 0;                        ///< commands that are not finite, too strong or too fast
    double strongest = 0.0, fastest = 0.0; ///< N, N in a tick
    double moves = 0.0;                    ///< of the proxy, sum over the contact ticks

    EffectFigures& operator+=(const EffectFigures& other);
};

/// What counts as on the surface, workspace m.
inline constexpr double kCertificate = 1e-6;

/// Strokes the case's body until `contactTicks` were in contact, or for eight times as many ticks. The seed
/// chooses places and directions. The world must be there.
[[nodiscard]] EffectFigures runEffects(const EffectCase& c, unsigned seed, int contactTicks,
                                       ContactMethod contact = ContactMethod::Sweep);

/// One hand along the path, workspace m; seed: which coefficients of friction.
[[nodiscard]] EffectFigures followEffects(const EffectCase& c, unsigned seed,
                                          std::span<const glm::dvec3> path);

[[nodiscard]] std::string effectHead();
[[nodiscard]] std::string effectLine(const EffectFigures& f);

} // namespace touchstone::test

#pragma once
// What every case of effects must show.

#include "tests/property/effects/effect_trial.h"

#include <array>

namespace touchstone::test {

inline constexpr std::array kEffectBodies{EffectBody::Sphere, EffectBody::FineSphere, EffectBody::Torus,
                                          EffectBody::Box,    EffectBody::Room,       EffectBody::Suzanne,
                                          EffectBody::ToyCar};
inline constexpr std::array kEffectStrokes{EffectStroke::Shallow, EffectStroke::Deep, EffectStroke::Fast};

/// In every tick that the budget did not end the proxy is on the surface within kCertificate, in those that
/// it ended in free space, and every command within its limits.
void expectOnSurface(const EffectFigures& f, unsigned seed);
/// Runs the case and expects that.
EffectFigures checkEffects(const EffectCase& c, unsigned seed, int contactTicks);
/// Of many cases: at most one tick in 500 ends off the surface at the budget, at most one in 500 is among
/// more triangles than a tick has room for or between closing jaws.
void expectFewLate(const EffectFigures& sum);

} // namespace touchstone::test

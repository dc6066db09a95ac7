#include "tests/property/effects/effect_checks.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace touchstone::test {

void expectOnSurface(const EffectFigures& f, unsigned seed) {
    // Objects that move are placed in double: 1e-16 of a workspace of decimetres, a thousandfold.
    constexpr double kPlacing = 1e-13;
    EXPECT_EQ(f.off, 0) << f.name << ", seed " << seed << ": up to " << f.worst << " m off the surface";
    EXPECT_EQ(f.left, 0) << f.name << ", seed " << seed << ": up to " << f.worst << " m from the HIP";
    EXPECT_LE(f.inside, kPlacing) << f.name << ", seed " << seed;
    EXPECT_EQ(f.limits, 0) << f.name << ", seed " << seed;
}

EffectFigures checkEffects(const EffectCase& c, unsigned seed, int contactTicks) {
    const EffectFigures f = runEffects(c, seed, contactTicks);
    expectOnSurface(f, seed);
    if (f.late > 0)
        std::printf("late: %s seed %u\n", effectLine(f).c_str(), seed);
    if (f.exempt > 0)
        std::printf("exempt: %s seed %u\n", effectLine(f).c_str(), seed);
    return f;
}

void expectFewLate(const EffectFigures& sum) {
    EXPECT_GT(sum.contact, 1000);
    EXPECT_LE(500 * sum.late, sum.contact) << sum.name;
    // Closing jaws, and a ball of 3 mm among more triangles than a tick has room for: the world's doing, and
    // none of the laws'.
    EXPECT_LE(400 * sum.exempt, sum.contact) << sum.name;
}

} // namespace touchstone::test

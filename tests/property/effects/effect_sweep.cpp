// The full product of the effects on every body under every stroke. Long: ctest -L sweep.

#include "tests/property/effects/effect_checks.h"
#include "tests/support/shared_files.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace touchstone::test {
namespace {

class EffectSweep : public testing::TestWithParam<EffectBody> {};

TEST_P(EffectSweep, LeavesTheProxyOnTheSurface) {
    const EffectBody body = GetParam();
    if (effectWorld(body) == nullptr)
        GTEST_SKIP() << kNoModels;
    std::printf("%s\n", effectHead().c_str());
    unsigned seed = 10000 * static_cast<unsigned>(body);
    for (const EffectStroke stroke : kEffectStrokes) {
        EffectFigures sum;
        for (const EffectCase& c : effectProduct(body, stroke))
            sum += checkEffects(c, ++seed, 100);
        sum.name = strokeName(body, stroke);
        std::printf("%s\n", effectLine(sum).c_str());
        std::fflush(stdout);
        expectFewLate(sum);
    }
}

INSTANTIATE_TEST_SUITE_P(On, EffectSweep, testing::ValuesIn(kEffectBodies),
                         [](const auto& param) { return bodyName(param.param, true); });

} // namespace
} // namespace touchstone::test

// Lives ticks of a plain scene and nothing else, for an instruction counter: tick_probe free|contact TICKS.

#include "engine/core/float_mode.h"
#include "tests/support/touch_bench.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

using namespace touchstone;

int main(int count, char** arguments) {
    if (count != 3) {
        std::fputs("usage: tick_probe free|contact TICKS\n", stderr);
        return 2;
    }
    enterFloatMode();
    const bool contact = std::strcmp(arguments[1], "contact") == 0;
    const int ticks = std::atoi(arguments[2]);
    // A flat-shaded torus: no normals to shade by, no texture, a material that says nothing.
    assets::Shape torus = assets::torus(0.06, 0.025, 180, 180);
    torus.normals.clear();
    test::TouchBench bench(test::sceneOf(torus));
    const double reach = contact ? 0.024 : 0.0255;
    const auto hand = [&](double metres, double lift) {
        const double a = metres / 0.084, v = 0.37 * a, r = reach + lift;
        return glm::dvec3((0.06 + r * std::cos(v)) * std::cos(a), (0.06 + r * std::cos(v)) * std::sin(a),
                          r * std::sin(v));
    };
    for (double lift = 0.005; lift > 0.0; lift -= 1e-4)
        bench.step(hand(0.0, lift));
    uint64_t inContact = 0;
    for (int i = 0; i < ticks; ++i)
        inContact += bench.step(hand(1e-4 * i, 0.0)).contacts > 0 ? 1 : 0;
    std::printf("%d ticks, %llu in contact\n", ticks, static_cast<unsigned long long>(inContact));
    return inContact == (contact ? static_cast<uint64_t>(ticks) : 0) ? 0 : 1;
}

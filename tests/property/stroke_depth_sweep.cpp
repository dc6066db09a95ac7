// stroke_depth_sweep: the invariant of the strokes on many random shapes. TOUCHSTONE_SWEEP_SEEDS="FROM TO"
// chooses them.

#include "tests/property/stroke_depth.h"
#include "tests/support/stroke_shapes.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <string>

namespace touchstone {
namespace {

TEST(StrokeDepthSweep, RandomShapes) {
    uint32_t from = 0, to = 3000;
    if (const char* range = std::getenv("TOUCHSTONE_SWEEP_SEEDS"))
        std::istringstream(range) >> from >> to;
    int broken = 0;
    for (uint32_t seed = from; seed < to; ++seed) {
        const test::StrokeShape shape = test::strokeShape(seed);
        broken += test::expectStrokes(std::make_shared<const Scene>(shape.scene),
                                      shape.name + " " + std::to_string(seed));
    }
    std::printf("seeds %u to %u: %d strokes broke the invariant\n", from, to, broken);
}

} // namespace
} // namespace touchstone

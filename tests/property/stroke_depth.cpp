#include "tests/property/stroke_depth.h"

#include "devices/stroke/stroke_library.h"
#include "engine/scene/animation.h"
#include "engine/scene/mesh_deformation.h"
#include "tests/support/felt_stroke.h"
#include "tests/support/sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace touchstone::test {

namespace {

/// Equal for paths that are equal to the bit.
uint64_t bitsOf(const StrokePath& path) {
    uint64_t hash = 0xcbf29ce484222325u;
    for (int i = 0; i < 4096; ++i) {
        const glm::dvec3 p = path.position(path.period() * i / 4096.0);
        for (const double c : {p.x, p.y, p.z})
            hash = (hash ^ std::bit_cast<uint64_t>(c)) * 0x100000001b3u;
    }
    return hash;
}

/// Where an animation starts again at another place a surface may come to enclose a hand, which then feels
/// nothing until it has left.
bool startsAgain(const Scene& scene, double time) {
    const Animation* const animation = playedAnimation(scene);
    return animation != nullptr && loopedTime(*animation, time) < 0.002;
}

} // namespace

int expectStrokes(const ScenePtr& scene, const std::string& name) {
    // Strokes do not follow bodies that hands and gravity move, rigid or soft (docs/bodies.md).
    if (scene->physics != nullptr || hasSoftBodies(*scene)) {
        std::printf("%s has bodies: left out\n", name.c_str());
        return 0;
    }
    const Similarity fit = workspaceFromScene(*scene, Fit::Workspace);
    const auto haptic = compileHapticScene(*scene, fit, {});
    const double diagonal = fit.scale * scene->bounds.diagonal();
    const bool table = std::getenv("TOUCHSTONE_STROKE_TABLE") != nullptr;
    int broken = 0;
    for (const StrokeInfo& info : strokeInfos()) {
        SCOPED_TRACE(name + ", " + std::string(info.name));
        const double asked = std::min(info.depth, 0.1 * diagonal);
        const StrokePath path = layStroke(*scene, fit, {.name = std::string(info.name)});
        // An animation meets the stroke at another phase in every period: a minute of it in the sweep.
        const double animated = repetitions(10, 60); // s
        const int periods =
            scene->animations.empty() ? 1 : 1 + static_cast<int>(std::ceil(animated / path.period()));
        const FeltStroke felt = feel(*haptic, path, scene, periods);
        if (table)
            std::printf("%s\t%s\t%.3f\t%.3f\t%.2f\t%016llx%s%s\n", name.c_str(),
                        std::string(info.name).c_str(), 1e3 * asked, 1e3 * felt.deepest,
                        static_cast<double>(felt.contact) / felt.ticks,
                        static_cast<unsigned long long>(bitsOf(path)), felt.began ? "\tbegan" : "",
                        felt.inside ? "\tinside" : "");
        EXPECT_GT(felt.contact, 0) << "it never touches";
        EXPECT_FALSE(felt.began) << "it begins in the air";
        const bool inside = felt.inside && !startsAgain(*scene, felt.insideAt);
        EXPECT_FALSE(inside) << "it begins inside a body at " << felt.insideAt << " s";
        EXPECT_LE(felt.deepest, kDepthFactor * asked) << "at " << felt.deepestAt << " s";
        broken += felt.contact == 0 || felt.began || inside || !(felt.deepest <= kDepthFactor * asked);
    }
    return broken;
}

} // namespace touchstone::test

// One-sided surfaces against the oracle: hands that come from anywhere, through and onto them.

#include "study/truth/oracle.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace touchstone::test {

using namespace truth;

namespace {

struct Count {
    int ticks = 0, standing = 0, through = 0, apart = 0;
    long double worst = 0.0L;
};

/// A hand goes straight from place to place about the model; every tick is solved by both from our last
/// place.
Count compare(const assets::Shape& shape, double radius, double speed, unsigned seed) {
    Scene scene = sceneOf(shape);
    scene.materials[0].haptic.sides = SideChoice::Front;
    HapticSettings s;
    s.forceShading = ShadingMode::Off;
    s.friction = FrictionMode::Off;
    s.proxyRadius = radius;
    TouchBench bench(scene, s);
    const HapticObject& object = *bench.scene->objects[0];
    const Soup soup(*bench.scene, 0);
    const Similarity& workspaceFromObject = object.workspaceFromObject;
    const auto reach = static_cast<long double>(
        std::max(radius / workspaceFromObject.scale, 0.5 * kWeldTolerance * object.diagonal));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> in(-0.09, 0.09), deep(-0.002, 0.002);
    Count count;
    const auto tick = [&](const glm::dvec3& hip) {
        const bool placed = bench.state[0].placed;
        const LVec3 before(bench.state[0].proxy);
        const HapticOutput& out = bench.step(hip);
        if (!placed || has(out.flags, TickFlag::BudgetReached))
            return;
        ++count.ticks;
        count.standing += out.contacts > 0 ? 1 : 0;
        const OracleRest rest = oracleRest(soup, before, LVec3(workspaceFromObject.inversePoint(hip)), reach);
        if (!rest.settled)
            return;
        const BruteContact nearest = soup.nearest(rest.proxy);
        count.through += nearest.distance < reach - 1e-8L ? 1 : 0;
        const long double error = glm::length(rest.proxy - LVec3(bench.state[0].proxy));
        if (error > 1e-7L)
            ++count.apart;
        else
            count.worst = std::max(count.worst, error);
    };
    glm::dvec3 hip(0.12, 0.01, 0.02);
    tick(hip);
    for (int way = 0; way < 20; ++way) {
        // Half of the ways end near a vertex of the surface, a little before or behind it.
        glm::dvec3 to(in(random), in(random), in(random));
        if (way % 2 == 0)
            to = workspaceFromObject.point(
                     glm::dvec3(object.vertices[random() % (object.vertices.size() - 1)])) +
                 glm::dvec3(deep(random), deep(random), deep(random));
        const glm::dvec3 from = hip;
        const int ticks = std::min(300, static_cast<int>(glm::length(to - from) / (speed * bench.dt)) + 1);
        for (int i = 1; i <= ticks; ++i)
            tick(hip = from + (to - from) * (static_cast<double>(i) / ticks));
    }
    return count;
}

assets::Shape inwards(assets::Shape shape) {
    for (size_t t = 0; t + 2 < shape.indices.size(); t += 3)
        std::swap(shape.indices[t + 1], shape.indices[t + 2]);
    return shape;
}

TEST(OneSidedExactness, HandsFromAnywhereRestWhereTheOracleDoes) {
    Count all;
    unsigned seed = 1;
    for (const assets::Shape& shape :
         {assets::torus(0.06, 0.025, 24, 16), inwards(assets::sphere(0.05, 16, 12)),
          assets::box({0.1, 0.1, 0.1}), inwards(assets::box({0.1, 0.1, 0.1})), assets::plane(0.1, 0.1, 3, 3)})
        for (const double radius : {0.0, 0.5e-3, 3e-3})
            for (const double speed : {0.2, 2.0}) {
                const Count c = compare(shape, radius, speed, seed++);
                all.ticks += c.ticks;
                all.standing += c.standing;
                all.through += c.through;
                all.apart += c.apart;
                all.worst = std::max(all.worst, c.worst);
                EXPECT_EQ(c.apart, 0)
                    << "shape " << (seed - 2) / 6 << " radius " << radius << " at " << speed;
            }
    std::printf("one-sided: %d ticks, %d standing, %d ending half through, %d apart, worst %.1Le\n",
                all.ticks, all.standing, all.through, all.apart, all.worst);
    EXPECT_GT(all.standing, 10000);
    EXPECT_GT(all.through, 100);
}

} // namespace
} // namespace touchstone::test

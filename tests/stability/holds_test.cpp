// Five hundred random holds: the force settles to a constant, and hand noise is not amplified inside one
// active set.

#include "tests/stability/hard_case.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace touchstone::test::holds_test {
namespace {

constexpr double kNoise = 5e-6; // m, rms
constexpr int kShakes = 60;

struct Body {
    std::string name;
    assets::Shape shape;
    double curvature; ///< m, least radius of curvature of the smooth shape; 0: flat faces
};

/// How often the active set may change while the HIP stays within `reach` of where it is: never where no edge
/// comes near; once where there is a convex one, which the proxy goes over and from where only the hysteresis
/// 2 d tan(theta / 2) > 2 reach would bring it back; as often as it likes where the faces meet in a hollow or
/// so nearly in one plane that the hysteresis is smaller than the noise: there the force has no jump. Shading
/// takes the hysteresis of an edge away with its jump.
int switchesAllowed(const HardCase& run, double depth, double reach) {
    const double radius = run.effectiveRadius();
    const glm::dvec3& proxy = run.bench.output.proxy;
    int allowed = 0;
    for (const double turn :
         run.surface().edgesAlong(run.motions(), proxy, proxy, radius + reach, 2.0 * radius)) {
        if (std::abs(turn) < 1e-6)
            continue; // one face in two pieces
        // Rounded by r, an edge is passed steadily until the HIP is deeper than its axis.
        const bool goesOver = turn > 0.0 && run.touching().tilt() == 0.0 && depth > radius &&
                              depth * std::tan(0.5 * turn) > reach;
        allowed = std::max(allowed, goesOver ? 1 : kShakes);
    }
    return allowed;
}

/// What holds the proxy: the directions, one for each face however many triangles it has.
bool sameSet(const Touching& a, const Touching& b) {
    const auto within = [](const Touching& x, const Touching& y) {
        return std::all_of(x.normals.begin(), x.normals.end(), [&](const glm::dvec3& n) {
            return std::any_of(y.normals.begin(), y.normals.end(),
                               [&](const glm::dvec3& m) { return angleBetween(n, m) < 1e-6; });
        });
    };
    return within(a, b) && within(b, a);
}

struct Tally {
    int holds = 0, loud = 0, switched = 0, nearHollows = 0, tooMany = 0;
    double largestGain = 0.0;
};

/// Shakes a held hand; counts the changes of the active set, and the response inside the first one.
void shake(HardCase& run, const Body& body, std::mt19937& random, Tally& tally) {
    std::normal_distribution<double> normal;
    const glm::dvec3 hip = run.bench.output.hip, rest = run.bench.output.force;
    const double depth = run.bench.output.penetration;
    const double gain =
        std::max(2.0, body.curvature > 0.0 ? 1.1 * body.curvature / (body.curvature - depth) : 2.0);
    std::vector<glm::dvec3> shakes;
    double farthest = 0.0;
    for (int i = 0; i < kShakes; ++i) {
        shakes.push_back(kNoise / std::sqrt(3.0) *
                         glm::dvec3(normal(random), normal(random), normal(random)));
        farthest = std::max(farthest, glm::length(shakes.back()));
    }
    const int allowed = switchesAllowed(run, depth, gain * farthest);
    const Touching first = run.touching();
    Touching last = first;
    double sum = 0.0, noise = 0.0;
    int count = 0, switches = 0;
    for (const glm::dvec3& by : shakes) {
        run.bench.step(hip + by);
        run.take();
        switches += sameSet(run.touching(), last) ? 0 : 1;
        last = run.touching();
        if (!sameSet(last, first))
            continue;
        const glm::dvec3 change = run.bench.output.force - rest;
        sum += glm::dot(change, change);
        noise += 1e6 * glm::dot(by, by);
        ++count;
    }
    tally.switched += switches > 0 ? 1 : 0;
    tally.nearHollows += allowed > 1 ? 1 : 0;
    tally.tooMany += switches > allowed ? 1 : 0;
    if (count > 10) {
        tally.largestGain = std::max(tally.largestGain, std::sqrt(sum / noise) / gain);
        tally.loud += std::sqrt(sum / noise) > gain ? 1 : 0;
    }
}

TEST(Holds, FiveHundredRandomHoldsSettleAndDoNotAmplifyTheHand) {
    const std::vector<Body> bodies{{"sphere1800", assets::sphere(0.05, 30, 30), 0.05},
                                   {"torus6480", assets::torus(0.06, 0.025, 72, 45), 0.025},
                                   {"box", assets::box({0.08, 0.09, 0.1}, 4), 0.0}};
    for (const Variant& v : allVariants()) {
        SCOPED_TRACE(v.name());
        std::vector<std::unique_ptr<HardCase>> runs;
        for (const Body& body : bodies)
            runs.push_back(std::make_unique<HardCase>("500 random holds", sceneOf(body.shape), v));
        std::mt19937 random(9);
        std::normal_distribution<double> normal;
        Tally tally;
        for (int trial = 0; tally.holds < 500 && trial < 2000; ++trial) {
            const Body& body = bodies[static_cast<size_t>(trial) % bodies.size()];
            HardCase& run = *runs[static_cast<size_t>(trial) % bodies.size()];
            // Tap along a random direction onto the surface, found by approaching until contact, then 1 mm
            // on.
            const glm::dvec3 direction =
                glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
            glm::dvec3 hip = 0.1 * direction;
            const glm::dvec3 aim = body.name == "torus6480" ? 0.06 / std::hypot(direction.x, direction.y) *
                                                                  glm::dvec3(direction.x, direction.y, 0.0)
                                                            : glm::dvec3(0.0);
            run.startAt(hip);
            const glm::dvec3 step = glm::normalize(aim - hip) * 5e-4;
            for (int i = 0; i < 400 && run.bench.output.contacts == 0; ++i) {
                run.bench.step(hip += step);
                run.take();
            }
            for (int i = 0; i < 2; ++i) {
                run.bench.step(hip += step);
                run.take();
            }
            if (run.bench.output.contacts == 0 || run.bench.output.penetration > 0.003)
                continue; // missed it, or slid off an edge while approaching
            ++tally.holds;
            run.hold(50);
            shake(run, body, random, tally);
        }
        for (const auto& run : runs)
            run->judge();
        EXPECT_EQ(tally.holds, 500);
        EXPECT_EQ(tally.loud, 0) << "largest gain, of what is allowed: " << tally.largestGain;
        EXPECT_EQ(tally.tooMany, 0) << "more plane switches than the edges in reach demand";
        std::printf("500 random holds, %s: gain at most %.3f of what is allowed; %d holds switched planes; "
                    "%d stood where they may more than once\n",
                    v.name().c_str(), tally.largestGain, tally.switched, tally.nearHollows);
    }
}

} // namespace
} // namespace touchstone::test::holds_test

// The bounds and the sweep of the candidates against brute force in long double.

#include "haptics/contact/candidates.h"
#include "haptics/contact/sweep.h"
#include "haptics/scene/haptic_scene.h"
#include "study/truth/brute_force.h"
#include "study/truth/soup.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace touchstone::test {

using namespace truth;

namespace {

struct World {
    std::string name;
    std::shared_ptr<const HapticScene> scene;
};

/// One object, and two at different scales that overlap: the second is foreign to the reference object's
/// frame.
std::vector<World> worlds() {
    std::vector<World> made;
    for (const auto& [name, shape] :
         std::vector<std::pair<std::string, assets::Shape>>{{"torus", assets::torus(0.06, 0.025, 72, 45)},
                                                            {"sphere", assets::sphere(0.05, 30, 30)},
                                                            {"slab", assets::box({1000.0, 0.1, 10.0}, 6)}})
        made.push_back({name, compileHapticScene(sceneOf(shape), Similarity{})});
    Scene two = sceneOf(assets::torus(0.06, 0.025, 72, 45));
    addShape(two, assets::sphere(0.05, 30, 30),
             glm::dmat4(0.3, 0, 0, 0, 0, 0, 0.3, 0, 0, -0.3, 0, 0, 0.06, 0.01, 0.02, 1));
    made.push_back({"two", compileHapticScene(two, Similarity{})});
    return made;
}

/// Places near the surface of the first object, in its frame.
class Places {
  public:
    explicit Places(const HapticScene& scene) : object_(*scene.objects[0]) {}
    glm::dvec3 next(double most) {
        const glm::dvec3 vertex(object_.vertices[random_() % (object_.vertices.size() - 1)]);
        return vertex + most * glm::dvec3(in_(random_), in_(random_), in_(random_));
    }
    double between(double low, double high) { return low + (high - low) * 0.5 * (in_(random_) + 1.0); }

  private:
    const HapticObject& object_;
    std::mt19937 random_{5};
    std::uniform_real_distribution<double> in_{-1.0, 1.0};
};

/// Balls of a hand that moves on: they overlap, but in each tenth it begins elsewhere.
struct Wander {
    glm::dvec3 centre{0.0}, way{0.0};
    void next(int trial, double speed, Places& places) {
        if (trial % 10 == 0) {
            centre = places.next(0.02);
            way = speed * glm::normalize(places.next(0.02) - centre);
        }
        centre += way * places.between(0.0, 1.0);
    }
};

TEST(Sweep, NoBoundExceedsTheDistance) {
    for (const World& world : worlds()) {
        SCOPED_TRACE(world.name);
        Places places(*world.scene);
        CandidateCache cache;
        size_t compared = 0, culled = 0;
        for (int trial = 0; trial < 200; ++trial) {
            const glm::dvec3 centre = places.next(0.02);
            const double radius = std::pow(10.0, places.between(-3.0, -1.0));
            if (!cache.gather(world.scene->objects, world.scene->restMotions, world.scene->restSpheres, 0,
                              centre, radius))
                continue;
            // Some are measured somewhere in the ball, so that boxes and gradients both are put to the test.
            for (size_t i = 0; i < cache.count(); i += 2)
                (void)cache.measureAhead(i, centre + places.between(0.0, 0.9) * (places.next(0.0) - centre));
            const glm::dvec3 p = centre + 0.5 * radius * glm::normalize(places.next(0.1) - centre);
            const double reach = places.between(0.0, 0.5) * radius;
            std::vector<bool> visited(cache.count(), false);
            cache.eachNear(p, reach, [&](size_t i) { visited[i] = true; });
            for (size_t i = 0; i < cache.count(); ++i) {
                const Triangle& t = cache.triangle(i);
                const Corners corners{LVec3(t.a), LVec3(t.b), LVec3(t.c)};
                ++compared;
                if (visited[i])
                    continue;
                ++culled;
                EXPECT_GT(distanceFrom(corners, LVec3(p)).distance, static_cast<long double>(reach))
                    << "triangle " << cache.item(i).index << " trial " << trial;
            }
        }
        EXPECT_GT(culled, compared / 10);
    }
}

// A hand that moves on: balls overlap, and what one has prepared and measured serves the next.
TEST(Sweep, NoBoundThatIsKeptFromBallToBallExceedsTheDistance) {
    size_t kept = 0, culled = 0;
    for (const World& world : worlds()) {
        SCOPED_TRACE(world.name);
        Places places(*world.scene);
        CandidateCache cache;
        Wander hand;
        const glm::dvec3& centre = hand.centre;
        for (int trial = 0; trial < 400; ++trial) {
            const double radius = std::pow(10.0, places.between(-2.0, -1.5));
            hand.next(trial, 0.01, places);
            std::vector<uint32_t> measured; // in the ball before
            for (size_t i = 0; i < cache.count(); i += 2) {
                (void)cache.measureAhead(i,
                                         centre + 0.5 * radius * glm::normalize(places.next(0.1) - centre));
                measured.push_back(cache.item(i).index);
            }
            ASSERT_TRUE(cache.gather(world.scene->objects, world.scene->restMotions, world.scene->restSpheres,
                                     0, centre, radius, CandidateCache::Frame::Same));
            const glm::dvec3 p = centre + 0.5 * radius * glm::normalize(places.next(0.1) - centre);
            const double reach = places.between(0.0, 0.5) * radius;
            std::vector<bool> visited(cache.count(), false);
            cache.eachNear(p, reach, [&](size_t i) { visited[i] = true; });
            for (size_t i = 0; i < cache.count(); ++i) {
                const Triangle& t = cache.triangle(i);
                const Triangle fresh = triangleOf(*world.scene->objects[0], cache.item(i).index);
                if (cache.item(i).object == 0) {
                    EXPECT_EQ(t.a, fresh.a);
                    EXPECT_EQ(t.normal, fresh.normal);
                }
                kept += std::ranges::count(measured, cache.item(i).index) > 0 ? 1 : 0;
                if (visited[i])
                    continue;
                ++culled;
                EXPECT_GT(distanceFrom({LVec3(t.a), LVec3(t.b), LVec3(t.c)}, LVec3(p)).distance,
                          static_cast<long double>(reach))
                    << "triangle " << cache.item(i).index << " trial " << trial;
            }
        }
    }
    EXPECT_GT(kept, 1000u);
    EXPECT_GT(culled, 1000u);
}

// What a gather asks for ahead is memory alone: the balls that follow hold the same triangles, with the same
// distances. Some balls prepare more than a cache keeps.
TEST(Sweep, ABallIsTheSameWhateverIsExpectedNext) {
    size_t most = 0;
    for (const World& world : worlds()) {
        SCOPED_TRACE(world.name);
        Places places(*world.scene);
        CandidateCache cache, plain;
        Wander hand;
        const glm::dvec3& centre = hand.centre;
        for (int trial = 0; trial < 200; ++trial) {
            const double radius = std::pow(10.0, places.between(-2.0, -0.5));
            hand.next(trial, 0.02, places);
            cache.expect(centre + hand.way * places.between(-1.0, 4.0),
                         trial % 7 == 0 ? 0.0 : radius * std::pow(10.0, places.between(-1.0, 3.0)));
            const auto gather = [&](CandidateCache& into) {
                return into.gather(world.scene->objects, world.scene->restMotions, world.scene->restSpheres,
                                   0, centre, radius, CandidateCache::Frame::Same);
            };
            ASSERT_EQ(gather(cache), gather(plain));
            ASSERT_EQ(cache.count(), plain.count());
            most = std::max(most, cache.count());
            const glm::dvec3 p = centre + 0.5 * radius * glm::normalize(places.next(0.1) - centre);
            for (size_t i = 0; i < cache.count(); ++i) {
                ASSERT_EQ(cache.item(i).index, plain.item(i).index);
                if ((i + static_cast<size_t>(trial)) % 3 == 0)
                    continue; // stays unprepared
                const TriangleDistance a = cache.measure(i, p), b = plain.measure(i, p);
                ASSERT_EQ(a.distance, b.distance);
                ASSERT_EQ(a.gradient, b.gradient);
                const Candidate& item = cache.item(i);
                if (item.object == 0) {
                    const Triangle fresh = triangleOf(*world.scene->objects[0], item.index);
                    ASSERT_EQ(cache.triangle(i).a, fresh.a);
                    ASSERT_EQ(cache.triangle(i).b, fresh.b);
                    ASSERT_EQ(cache.triangle(i).c, fresh.c);
                }
            }
            for (int tick = 0; tick < trial % 4; ++tick)
                cache.fetchOn();
            if (trial % 23 == 0) {
                cache.invalidate();
                plain.invalidate();
                cache.fetchOn();
            }
        }
    }
    EXPECT_GT(most, 600u);
}

TEST(Sweep, NothingIsReadOfASceneThatIsGone) {
    std::vector<World> gone = worlds();
    CandidateCache cache;
    for (World& world : gone) {
        Places places(*world.scene);
        cache.expect(places.next(0.02), 1.0);
        ASSERT_TRUE(cache.gather(world.scene->objects, world.scene->restMotions, world.scene->restSpheres, 0,
                                 places.next(0.02), 0.02, CandidateCache::Frame::Same));
        cache.invalidate();
        world.scene.reset();
        cache.fetchOn();
    }
}

TEST(Sweep, EndsAtTheFirstTouchAndNotLater) {
    constexpr double kTouch = 2e-13; // of sweep.cpp, with rounding
    for (const World& world : worlds()) {
        SCOPED_TRACE(world.name);
        const Soup soup(*world.scene, 0);
        Places places(*world.scene);
        CandidateCache cache;
        int hit = 0, passed = 0;
        for (int trial = 0; trial < 800; ++trial) {
            const double reach = std::pow(10.0, places.between(-6.3, -2.0));
            const glm::dvec3 start = places.next(0.05);
            const glm::dvec3 move = places.next(0.01) - start;
            if (soup.nearest(LVec3(start)).distance <= static_cast<long double>(reach))
                continue;
            if (!cache.gather(world.scene->objects, world.scene->restMotions, world.scene->restSpheres, 0,
                              start, glm::length(move) + reach + 1e-6))
                continue;
            cache.moved();
            const double share = timeOfImpact(cache, start, move, reach, 1.0);
            const LVec3 end = LVec3(start) + static_cast<long double>(share) * LVec3(move);
            const auto enough = static_cast<long double>(reach);
            EXPECT_GT(soup.clearance(LVec3(start), end, enough), enough - static_cast<long double>(kTouch))
                << "ran into something, trial " << trial;
            if (share < 1.0) {
                ++hit;
                EXPECT_LT(soup.nearest(end).distance, enough + static_cast<long double>(kTouch))
                    << "stopped in free space, trial " << trial;
            } else {
                ++passed;
            }
        }
        EXPECT_GT(hit, 100);
        EXPECT_GT(passed, 20);
    }
}

TEST(Sweep, AFullBallIsRefused) {
    // A fan of more triangles than a cache holds around one vertex.
    const auto scene = compileHapticScene(sceneOf(assets::sphere(0.05, 100, 100)), Similarity{});
    CandidateCache cache;
    EXPECT_FALSE(
        cache.gather(scene->objects, scene->restMotions, scene->restSpheres, 0, glm::dvec3(0.0), 2.0));
    EXPECT_EQ(cache.count(), 0u);
    EXPECT_LT(cache.freeAlong(glm::dvec3(0.0), glm::dvec3(0.0), 0.0), 0.0);
    EXPECT_TRUE(cache.gather(scene->objects, scene->restMotions, scene->restSpheres, 0,
                             glm::dvec3(scene->objects[0]->vertices[0]), 0.01));
    EXPECT_GT(cache.count(), 0u);
}

} // namespace
} // namespace touchstone::test

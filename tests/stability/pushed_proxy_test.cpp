// A proxy between objects that move: pressed on a wall, up a slope, between jaws, about a room by a paddle;
// pulled from under it; put elsewhere.

#include "tests/stability/moving_world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace touchstone::test::pushed_proxy_test {
namespace {

using Box = MovingWorld::Box;
constexpr double kStiffness = 1000.0;
constexpr double kDt = 1e-3;
/// A proxy of radius zero has half the weld tolerance of the largest object touched, m.
constexpr double kSkin = 1e-6;

/// Runs `test` for every radius, shading and speed.
void everyWay(const std::function<void(const Variant&, double)>& test) {
    for (const Variant& v : allVariants())
        for (const double speed : allSpeeds()) {
            SCOPED_TRACE(v.name() + " at " + std::to_string(speed) + " m/s");
            test(v, speed);
            if (testing::Test::HasFailure())
                return;
        }
}

/// Moves a number from `from` to `to` at a speed, one step a tick.
void glide(double from, double to, double speed, const std::function<void(double)>& each) {
    const int ticks = std::max(1, static_cast<int>(std::ceil(std::abs(to - from) / (speed * kDt))));
    for (int i = 1; i <= ticks; ++i)
        each(from + (to - from) * i / ticks);
}

/// A floor with its top at y = 0 and a piston above it, whose lower face is at `y`.
Similarity pistonAt(double y) {
    return posed({0.0, y + 0.05, 0.0});
}
MovingWorld floorAndPiston(const Variant& v, double y) {
    return MovingWorld(v, {{{0.2, 0.04, 0.2}, posed({0.0, -0.02, 0.0})}, {{0.1, 0.1, 0.1}, pistonAt(y)}});
}

TEST(PushedProxy, APistonPressesTheHandOntoAWallAndLetsItGoAgain) {
    everyWay([](const Variant& v, double speed) {
        // The hand presses into the floor or, higher, against the piston that comes down.
        for (const double depth : {-0.002, 0.012}) {
            MovingWorld world = floorAndPiston(v, 0.06);
            const glm::dvec3 hand(0.01, depth, 0.02);
            world.step({0.01, 0.02, 0.02});
            for (int i = 0; i < 20; ++i)
                world.step(hand);
            const auto press = [&](double y) {
                world.boxes[1].pose = pistonAt(y);
                world.step(hand);
                const double most = kStiffness * (std::abs(depth) + 0.02);
                ASSERT_LE(glm::length(world.bench.output.force), most);
            };
            // To a gap that holds the proxy.
            glide(0.06, 0.003, speed, press);
            EXPECT_EQ(world.pinchedTicks, 0);
            EXPECT_GT(world.bench.output.proxy.y, 0.0);
            EXPECT_LT(world.bench.output.proxy.y, 0.003);
            EXPECT_LE(world.largestStep, kStiffness * std::max(speed * kDt, 0.0225)) << "N in one tick";
            // Shut: 1 mm into the floor.
            glide(0.003, -0.001, speed, press);
            EXPECT_TRUE(world.jammed());
            EXPECT_LT(std::abs(world.bench.output.proxy.y), 0.003) << "it stays where it is squeezed";
            const int jammed = world.pinchedTicks;
            world.largestStep = 0.0;
            for (int i = 0; i < 50; ++i)
                press(-0.001);
            EXPECT_EQ(world.pinchedTicks, jammed + 50);
            EXPECT_LT(world.largestStep, 1e-6) << "shut it holds still";
            // Open again: between the two as if nothing had been.
            glide(-0.001, 0.06, speed, press);
            EXPECT_FALSE(world.jammed());
            world.step(hand);
            EXPECT_NEAR(world.bench.output.proxy.y, std::max(depth, v.radius), kSkin);
            EXPECT_EQ(world.bench.output.object, depth < 0.0 ? 0 : -1);
        }
    });
}

TEST(PushedProxy, APistonPushesTheHandUpASlopeAndItComesDownBehind) {
    everyWay([](const Variant& v, double speed) {
        const double angle = std::numbers::pi / 6.0;
        // A slope through the origin, rising along x; the piston comes along x.
        const glm::dvec3 up(-std::sin(angle), std::cos(angle), 0.0),
            along(std::cos(angle), std::sin(angle), 0.0);
        const auto at = [](double face) { return posed({face - 0.05, 0.0, 0.0}); };
        MovingWorld world(v, {{{0.4, 0.04, 0.2}, posed(-0.02 * up, angle)}, {{0.1, 0.3, 0.1}, at(-0.02)}});
        const glm::dvec3 hand = -0.003 * up;
        world.step(0.02 * up);
        for (int i = 0; i < 20; ++i)
            world.step(hand);
        const glm::dvec3 rest = world.bench.output.proxy;
        EXPECT_NEAR(glm::length(rest - v.radius * up), 0.0, kSkin);
        world.largestStep = 0.0;
        glide(-0.02, 0.04, speed, [&](double face) {
            world.boxes[1].pose = at(face);
            const glm::dvec3 p = world.step(hand).proxy;
            // The slide is exact: on the slope and, once reached, on the piston's face.
            const double s = std::max(0.0, (face + v.radius - v.radius * up.x) / along.x);
            ASSERT_NEAR(glm::length(p - v.radius * up - s * along), 0.0, kSkin);
        });
        EXPECT_EQ(world.pinchedTicks, 0);
        EXPECT_LE(world.largestStep, kStiffness * (std::min(speed * kDt, 0.06) / along.x + 1e-6));
        glide(0.04, -0.02, speed, [&](double face) {
            world.boxes[1].pose = at(face);
            world.step(hand);
        });
        world.step(hand);
        EXPECT_NEAR(glm::length(world.bench.output.proxy - rest), 0.0, kSkin);
    });
}

TEST(PushedProxy, TwoJawsCloseOnTheHandAndOpenAgain) {
    everyWay([](const Variant& v, double speed) {
        // Both move; shut, each is half a millimetre past the middle, or 8 mm (through each other).
        for (const double shut : {-0.0005, -0.008}) {
            const auto at = [](double side, double gap) { return posed({side * (gap + 0.01), 0.0, 0.0}); };
            MovingWorld world(v, {{{0.02, 0.1, 0.1}, at(1, 0.03)}, {{0.02, 0.1, 0.1}, at(-1, 0.03)}});
            const glm::dvec3 hand(0.002, 0.01, 0.01);
            const auto close = [&](double gap) {
                world.boxes[0].pose = at(1, gap);
                world.boxes[1].pose = at(-1, gap);
                world.step(hand);
                ASSERT_LE(glm::length(world.bench.output.force), kStiffness * 0.015);
            };
            close(0.03);
            glide(0.03, 0.001, speed, close);
            EXPECT_EQ(world.pinchedTicks, 0) << "there is room for it";
            glide(0.001, shut, speed, close);
            EXPECT_TRUE(world.jammed());
            for (int i = 0; i < 20; ++i)
                close(shut);
            glide(shut, 0.03, speed, close);
            close(0.03);
            EXPECT_FALSE(world.jammed());
            EXPECT_NEAR(glm::length(world.bench.output.proxy - hand), 0.0, 1e-9) << "free again";
            EXPECT_EQ(glm::length(world.bench.output.force), 0.0);
        }
    });
}

TEST(PushedProxy, AWedgeOfJawsSqueezesTheHandOut) {
    everyWay([](const Variant& v, double speed) {
        // Jaws that open by 10 degrees upwards: closing, they drive the proxy up and out.
        const double tilt = 5.0 * std::numbers::pi / 180.0;
        const auto at = [&](double side, double gap) {
            return posed({side * (gap + 0.01), 0.0, 0.0}, -side * tilt);
        };
        MovingWorld world(v, {{{0.02, 0.04, 0.1}, at(1, 0.01)}, {{0.02, 0.04, 0.1}, at(-1, 0.01)}});
        const glm::dvec3 hand(0.0, 0.0, 0.01);
        const auto close = [&](double gap) {
            world.boxes[0].pose = at(1, gap);
            world.boxes[1].pose = at(-1, gap);
            world.step(hand);
        };
        close(0.01);
        glide(0.01, -0.001, speed, close);
        EXPECT_EQ(world.pinchedTicks, 0);
        EXPECT_GT(world.bench.output.proxy.y, 0.01);
        EXPECT_LT(std::abs(world.bench.output.proxy.x), 1e-6);
    });
}

/// A room of four walls about the z axis, inner half width 0.06, and what turns in it.
std::vector<Box> roomWithPaddle(double halfLength) {
    return {{{0.02, 0.16, 0.1}, posed({0.07, 0.0, 0.0})},
            {{0.02, 0.16, 0.1}, posed({-0.07, 0.0, 0.0})},
            {{0.12, 0.02, 0.1}, posed({0.0, 0.07, 0.0})},
            {{0.12, 0.02, 0.1}, posed({0.0, -0.07, 0.0})},
            {{2.0 * halfLength, 0.004, 0.08}, posed({})}};
}

TEST(PushedProxy, APaddleTurnsInARoomWithAStillHand) {
    everyWay([](const Variant& v, double speed) {
        // The tip leaves 5 mm to the walls, or less than the proxy's diameter.
        for (const double half : {0.055, 0.0598}) {
            for (const glm::dvec3& hand : {glm::dvec3(0.04, 0.01, 0.0), glm::dvec3(0.063, 0.02, 0.0)}) {
                MovingWorld world(v, roomWithPaddle(half));
                world.step({0.04, 0.01, 0.0});
                const double turn = speed * kDt / half;
                const int ticks = std::min(4000, static_cast<int>(15.0 / turn));
                for (int i = 1; i <= ticks && !testing::Test::HasFailure(); ++i) {
                    world.boxes[4].pose = posed({}, turn * i);
                    const glm::dvec3 p = world.step(hand).proxy;
                    ASSERT_LE(std::max(std::abs(p.x), std::abs(p.y)), 0.06 - v.radius + 1e-9)
                        << "out of the room";
                }
                EXPECT_EQ(world.pinchedTicks, 0);
                EXPECT_GT(world.contactTicks, 0);
            }
        }
    });
}

TEST(PushedProxy, ARoomThatTurnsAsOneIsRigidAtAnySpeed) {
    everyWay([](const Variant& v, double speed) {
        MovingWorld world(v, roomWithPaddle(0.03));
        const std::vector<Box> rest = world.boxes;
        world.step({0.045, 0.0, 0.0});
        const double turn = speed * kDt / 0.06;
        const glm::dvec3 pivot(0.01, -0.02, 0.0); // not the origin of any of them
        for (int i = 1; i <= 200 && !testing::Test::HasFailure(); ++i) {
            const glm::dquat by = glm::angleAxis(turn * i, glm::dvec3(0, 0, 1));
            for (size_t k = 0; k < world.boxes.size(); ++k) {
                world.boxes[k].pose.rotation = by * rest[k].pose.rotation;
                world.boxes[k].pose.translation = pivot + by * (rest[k].pose.translation - pivot);
            }
            const glm::dvec3 p = glm::conjugate(by) * (world.step({0.062, 0.0, 0.0}).proxy - pivot) + pivot;
            ASSERT_LE(std::max(std::abs(p.x), std::abs(p.y)), 0.06 - v.radius + 1e-9);
        }
        EXPECT_EQ(world.pinchedTicks, 0);
    });
}

TEST(PushedProxy, WhatIsPulledAwayTakesNothingAlong) {
    everyWay([](const Variant& v, double speed) {
        // The hand presses 5 mm into a block that drops away; a shelf stands inside the block, lower.
        MovingWorld world(
            v, {{{0.1, 0.1, 0.1}, posed({0.0, -0.05, 0.0})}, {{0.05, 0.01, 0.05}, posed({0.0, -0.03, 0.0})}});
        const glm::dvec3 hand(0.0, -0.005, 0.0);
        world.step({0.0, 0.01, 0.0});
        for (int i = 0; i < 10; ++i)
            world.step(hand);
        EXPECT_NEAR(world.bench.output.force.y, kStiffness * (0.005 + v.radius), 1e-3);
        double last = world.bench.output.force.y;
        glide(-0.05, -0.2, speed, [&](double y) {
            world.boxes[0].pose = posed({0.0, y, 0.0});
            const double force = world.step(hand).force.y;
            ASSERT_LE(force, last + 1e-9) << "it only ever lets go";
            last = force;
        });
        EXPECT_NEAR(glm::length(world.bench.output.proxy - hand), 0.0, 1e-9);
    });
}

TEST(PushedProxy, WhatJumpsDoesNotSweep) {
    for (const Variant& v : allVariants()) {
        SCOPED_TRACE(v.name());
        // A table beside a wall; the hand presses on both.
        MovingWorld world(
            v, {{{0.1, 0.1, 0.1}, posed({0.0, -0.05, 0.0})}, {{0.02, 0.1, 0.1}, posed({0.03, 0.0, 0.0})}});
        const glm::dvec3 hand(0.022, -0.003, 0.0);
        const auto put = [&](double y) {
            world.boxes[0].pose = posed({0.0, y, 0.0});
            world.boxes[0].jumped = true;
            const bool touching = world.bench.state[0].placed;
            world.step(hand);
            EXPECT_TRUE(has(world.bench.output.flags, TickFlag::ObjectJumped) || !touching);
            world.step(hand);
            EXPECT_FALSE(has(world.bench.output.flags, TickFlag::ObjectJumped));
        };
        world.step({0.01, 0.01, 0.0});
        for (int i = 0; i < 10; ++i)
            world.step(hand);
        EXPECT_GT(world.bench.output.force.y, 2.9);
        EXPECT_LT(world.bench.output.force.x, -1.9);
        put(-0.25); // away: the wall alone is left
        EXPECT_NEAR(world.bench.output.force.y, 0.0, 1e-9);
        EXPECT_NEAR(world.bench.output.force.x, -kStiffness * (0.002 + v.radius), 1e-3);
        put(-0.02); // around the proxy: nothing until it is out
        EXPECT_TRUE(has(world.bench.output.flags, TickFlag::StartedInside));
        EXPECT_EQ(glm::length(world.bench.output.force), 0.0);
        put(-0.25);
        for (double x = 0.022; x > 0.0; x -= 1e-3)
            world.step({x, -0.003, 0.0});
        world.step({0.0, -0.003, 0.0});
        EXPECT_FALSE(has(world.bench.output.flags, TickFlag::StartedInside));
        world.boxes[0].pose = posed({0.0, -0.055, 0.0}); // comes back by a sweep of 20 cm in one tick
        world.step({0.0, -0.003, 0.0});
        EXPECT_NEAR(world.bench.output.proxy.y, -0.003, 1e-3 + v.radius);
    }
}

TEST(PushedProxy, OverlappingObjectsMoveThroughEachOther) {
    everyWay([](const Variant& v, double speed) {
        MovingWorld world(
            v, {{{0.1, 0.04, 0.1}, posed({-0.03, 0.0, 0.0})}, {{0.1, 0.04, 0.1}, posed({0.03, 0.0, 0.0})}},
            2);
        const glm::dvec3 hand(0.0, 0.017, 0.01);
        world.step({0.0, 0.04, 0.01});
        for (int i = 0; i < 10; ++i)
            world.step(hand);
        // To and fro against each other, up and down, tilting.
        const double rate = speed * kDt / 0.02;
        for (int i = 1; i <= 400 && !testing::Test::HasFailure(); ++i) {
            const double a = rate * i;
            world.boxes[0].pose =
                posed({-0.03 + 0.02 * std::sin(a), 0.01 * std::sin(1.3 * a), 0.0}, 0.2 * std::sin(0.7 * a));
            world.boxes[1].pose =
                posed({0.03 - 0.02 * std::sin(1.1 * a), 0.01 * std::cos(a), 0.0}, 0.2 * std::sin(0.9 * a));
            ASSERT_GT(world.step(hand).proxy.y, -0.02);
        }
        EXPECT_EQ(world.pinchedTicks, 0);
    });
}

TEST(PushedProxy, WhatGrowsPushesToo) {
    everyWay([](const Variant& v, double speed) {
        MovingWorld world(
            v, {{{0.06, 0.06, 0.06}, posed({0.0, 0.0, 0.0})}, {{0.02, 0.3, 0.3}, posed({0.06, 0.0, 0.0})}});
        const glm::dvec3 hand(0.035, 0.0, 0.0); // between the block at 0.03 and the wall at 0.05
        world.step(hand);
        const auto grow = [&](double half) {
            world.boxes[0].pose.scale = half / 0.03;
            const glm::dvec3 p = world.step(hand).proxy;
            ASSERT_LT(p.x, 0.05);
            ASSERT_GT(p.x, half);
        };
        glide(0.03, 0.048, speed, grow);
        EXPECT_NEAR(world.bench.output.proxy.x, 0.048 + v.radius, 1e-6);
        glide(0.048, 0.03, speed, grow);
        EXPECT_EQ(world.pinchedTicks, 0);
        EXPECT_NEAR(world.bench.output.proxy.x, 0.035, 1e-9);
    });
}

TEST(PushedProxy, ASoakAmongManyMoversNeverPassesThrough) {
    int contacts = 0;
    for (const Variant& v : allVariants())
        for (const double speed : {0.05, 1.0, 5.0, 50.0}) {
            SCOPED_TRACE(v.name() + " at " + std::to_string(speed) + " m/s");
            std::mt19937 random(17);
            std::uniform_real_distribution<double> unit(-1.0, 1.0);
            const auto vector = [&](double size) {
                return size * glm::dvec3(unit(random), unit(random), unit(random));
            };
            struct Course {
                glm::dvec3 centre, swing, rate, phase, axis;
                double turn;
            };
            std::vector<Box> boxes;
            std::vector<Course> courses;
            for (int k = 0; k < 16; ++k) {
                boxes.push_back({glm::dvec3(0.03) + glm::abs(vector(0.05)), posed({})});
                courses.push_back({vector(0.07), vector(0.03), vector(1.0), vector(3.0),
                                   glm::normalize(vector(1.0) + glm::dvec3(0, 0, 1.5)), unit(random)});
            }
            const auto place = [&](MovingWorld& world, double t) {
                for (size_t k = 0; k < courses.size(); ++k) {
                    const Course& c = courses[k];
                    const glm::dvec3 a = t * c.rate + c.phase;
                    world.boxes[k].pose = posed(c.centre + c.swing * glm::sin(a), t * c.turn, c.axis);
                }
            };
            MovingWorld world(v, boxes);
            place(world, 0.0);
            world.step({0.0, 0.0, 0.2});
            for (int i = 1; i <= 3000 && !testing::Test::HasFailure(); ++i) {
                const double t = i * speed * kDt / 0.04;
                place(world, t);
                world.step({0.04 * std::sin(0.31 * t), 0.04 * std::cos(0.23 * t), 0.15 * std::cos(0.7 * t)});
            }
            contacts += world.contactTicks;
        }
    EXPECT_GT(contacts, 5000);
}

} // namespace
} // namespace touchstone::test::pushed_proxy_test

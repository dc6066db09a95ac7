#include "tests/support/allocation_counter.h"
#include "tests/unit/body/body_maker.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <thread>

namespace touchstone::test {

namespace {

BodyMaker onFloor(double friction, double restitution) {
    BodyMaker maker;
    const size_t wood = maker.surface(friction, restitution);
    maker.box(maker.node("floor", {0.0, -0.05, 0.0}), {4.0, 0.1, 4.0}, wood);
    return maker;
}

TEST(Contacts, AStackOfTenStandsAndFallsAsleep) {
    BodyMaker maker = onFloor(0.6, 0.0);
    for (int i = 0; i < 10; ++i) {
        const size_t block = maker.node("block " + std::to_string(i), {0.0, 0.01 + 0.02 * i, 0.0});
        maker.box(block, {0.04, 0.02, 0.04}, 0);
        maker.motion(block, {{"mass", 0.05}});
    }
    Bodies bodies(maker);
    bodies.run(3.0);
    const glm::dvec3 top = bodies.at("block 9").pose.position;
    std::printf("stack: the top moved by %.4f mm and sank by %.4f mm; %zu awake\n",
                1e3 * std::hypot(top.x, top.z), 1e3 * (0.19 - top.y), bodies.world->awake());
    EXPECT_LT(std::hypot(top.x, top.z), 5e-4);
    EXPECT_NEAR(top.y, 0.19, 1e-3);
    EXPECT_EQ(bodies.world->awake(), 0u);
}

TEST(Contacts, ABallFallsOnAFloorAndRolls) {
    BodyMaker maker = onFloor(0.5, 0.0);
    const size_t ball = maker.node("ball", {0.0, 0.05, 0.0});
    maker.ball(ball, 0.02, 0);
    maker.motion(ball, {{"mass", 0.1}, {"linearVelocity", {0.5, 0.0, 0.0}}});
    Bodies bodies(maker);
    bodies.run(1.5);
    const body::BodyState& at = bodies.at("ball");
    // Sliding until it rolls: 5/7 of the speed is left.
    EXPECT_NEAR(at.velocity.x, 0.5 * 5.0 / 7.0, 0.01 * 0.5);
    EXPECT_NEAR(at.spin.z, -at.velocity.x / 0.02, 0.2);
    EXPECT_NEAR(at.pose.position.y, 0.02, 1e-4);
}

TEST(Contacts, ABoxThatIsThrownAtAWallStaysBeforeIt) {
    for (const double speed : {0.5, 2.0, 5.0}) {
        BodyMaker maker = onFloor(0.5, 0.3);
        maker.box(maker.node("wall", {0.2, 0.1, 0.0}), {0.01, 0.4, 1.0}, 0);
        const size_t box = maker.node("box", {0.0, 0.05, 0.0});
        maker.box(box, {0.02, 0.02, 0.02}, 0);
        maker.motion(
            box,
            {{"mass", 0.05}, {"linearVelocity", {speed, 1.0, 0.0}}, {"angularVelocity", {3.0, 5.0, 7.0}}});
        Bodies bodies(maker);
        while (bodies.time < 2.0) {
            bodies.step();
            ASSERT_LT(bodies.at("box").pose.position.x, 0.195) << speed;
            ASSERT_GT(bodies.at("box").pose.position.y, 0.009) << speed;
        }
    }
}

/// Bullet clipped against the faces of hulls that have none, and inertia was 1/0.
TEST(Contacts, BodiesTooFlatOrTooSmallForNumbersHarmNobody) {
    using Scale = std::vector<double>;
    for (const Scale& scale :
         {Scale{1.0, 0.0, 1.0}, Scale{0.0, 0.0, 0.0}, Scale{0.0, 1.0, 0.0}, Scale{1e-9, 1e-9, 1e-9},
          Scale{1e-20, 1.0, 1.0}, Scale{1e-150, 1e-150, 1e-150}, Scale{1e9, 1e9, 1e9}})
        for (const bool stated : {false, true}) {
            BodyMaker maker = onFloor(0.6, 0.0);
            (void)addCube(maker, "sound", {0.0, 0.01, 0.0}, 0.02, 0.05);
            for (int i = 0; i < 3; ++i) {
                const size_t odd = addCube(maker, "odd", {0.012 * i, 0.02 + 0.003 * i, 0.0}, 0.02, 0.05);
                maker.json["nodes"][odd]["scale"] = scale;
                maker.part(odd)["collider"]["geometry"] = {{"node", odd}, {"convexHull", true}};
                if (!stated)
                    maker.motion(odd, nlohmann::json::object());
            }
            Bodies bodies(maker);
            bodies.run(0.3);
            for (const body::BodyState& state : bodies.world->states())
                EXPECT_TRUE(body::isSound(state)) << scale[0] << " " << scale[1];
            if (scale[0] < 1.0) { // the large ones bury it
                EXPECT_LT(glm::length(bodies.at("sound").pose.position - glm::dvec3(0.0, 0.01, 0.0)), 0.02)
                    << scale[0] << " " << scale[1];
            }
        }
}

TEST(Contacts, EqualPosesGiveEqualContacts) {
    BodyMaker maker = onFloor(0.5, 0.0);
    for (int i = 0; i < 12; ++i) {
        const size_t box = maker.node("box", {0.03 * (i % 3), 0.02 + 0.03 * (i / 3), 0.002 * i});
        if (i % 2 == 0)
            maker.box(box, {0.02, 0.02, 0.02}, 0);
        else
            maker.ball(box, 0.01, 0);
        maker.motion(box, {{"mass", 0.05}});
    }
    Bodies one(maker), other(maker);
    size_t most = 0;
    for (int i = 0; i < 1500; ++i) {
        one.step();
        other.step();
        most = std::max(most, one.world->solver().contacts().size());
        if (i == 200) { // the state, whole, in another world
            std::vector<std::byte> bytes(one.world->stateCapacity());
            bytes.resize(one.world->save(bytes));
            other.run(0.05);
            ASSERT_TRUE(other.world->restore(bytes));
        }
        for (size_t b = 0; b < one.world->states().size(); ++b)
            ASSERT_EQ(one.world->states()[b].pose.position, other.world->states()[b].pose.position) << i;
    }
    EXPECT_GT(most, 12u);
}

TEST(Contacts, AStateThatIsDamagedIsRefused) {
    BodyMaker maker = onFloor(0.5, 0.0);
    const size_t box = maker.node("box", {0.0, 0.01, 0.0});
    maker.box(box, {0.02, 0.02, 0.02}, 0);
    maker.motion(box, {{"mass", 0.05}});
    Bodies bodies(maker);
    bodies.run(0.1);
    std::vector<std::byte> bytes(bodies.world->stateCapacity());
    bytes.resize(bodies.world->save(bytes));
    ASSERT_GT(bodies.world->solver().contacts().size(), 0u);
    const glm::dvec3 at = bodies.at("box").pose.position;
    for (size_t size = 0; size < bytes.size(); size += 3)
        EXPECT_FALSE(bodies.world->restore({bytes.data(), size}));
    for (size_t i = 0; i < bytes.size(); ++i) { // any byte: refused, or taken without harm
        std::vector<std::byte> damaged = bytes;
        damaged[i] ^= std::byte{0xff};
        (void)bodies.world->restore(damaged);
        bodies.run(0.005);
    }
    ASSERT_TRUE(bodies.world->restore(bytes));
    EXPECT_EQ(bodies.at("box").pose.position, at);
}

TEST(Contacts, TheImpulseGoesThroughNewtonsCradle) {
    Bodies bodies(loadScene(TOUCHSTONE_ASSETS "/cradle.glb"));
    const double rest = bodies.at("ball 5").pose.position.y,
                 begin = bodies.at("ball 1").pose.position.y - rest;
    ASSERT_GT(begin, 0.01);
    double highest = 0.0, middle = 0.0;
    while (bodies.time < 0.6) {
        bodies.step();
        highest = std::max(highest, bodies.at("ball 5").pose.position.y - rest);
        middle = std::max(middle, bodies.at("ball 3").pose.position.y - rest);
    }
    std::printf("cradle: the last ball rises %.3f mm of %.3f, the middle one %.4f\n", 1e3 * highest,
                1e3 * begin, 1e3 * middle);
    EXPECT_NEAR(highest, begin, 0.01 * begin);
    EXPECT_LT(middle, 0.02 * begin);
}

TEST(Contacts, FoundApartNothingAllocatesOnTheServo) {
    BodyMaker maker = onFloor(0.5, 0.0);
    for (int i = 0; i < 10; ++i) {
        const size_t box = maker.node("box", {0.001 * i, 0.02 + 0.03 * i, 0.0});
        maker.box(box, {0.02, 0.02, 0.02}, 0);
        maker.motion(box, {{"mass", 0.05}});
    }
    Bodies bodies(maker);
    bodies.world->setFinding(body::BodyWorld::Finding::Apart);
    std::vector<ObjectMotion> motions = bodies.haptic->restMotions;
    uint64_t found = 0;
    const uint64_t before = allocationsOnThisThread();
    for (int i = 0; i < 2000 || (found < 3 && i < 20'000); ++i) {
        // As the servo does: the finder needs time, in which unpaced ticks would let the boxes fall for ever.
        if (found < 3)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        bodies.step();
        (void)bodies.world->writePoses(motions, false);
        found += bodies.world->found() > 0 ? 1 : 0;
        if (i % 500 == 0)
            (void)bodies.world->keep(static_cast<uint64_t>(i));
    }
    EXPECT_EQ(allocationsOnThisThread(), before);
    EXPECT_GE(found, 3u);
}

} // namespace

} // namespace touchstone::test

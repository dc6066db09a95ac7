#include "devices/plant/hand_impedance.h"
#include "devices/simulated/told_hand.h"
#include "engine/core/error.h"
#include "tests/support/allocation_counter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace touchstone::plant_test {
namespace {

constexpr glm::dvec3 kNowhere{0.0};

PlantParameters bare(double mass, double viscous = 0.0, double coulomb = 0.0) {
    PlantParameters p;
    p.mass = mass;
    p.viscousFriction = viscous;
    p.coulombFriction = coulomb;
    p.resolution = 0.0;
    p.maxForce = 1000.0;
    p.handMass = p.handDamping = p.handStiffness = 0.0;
    return p;
}

TEST(Plant, FallsFreelyUnderAHeldForce) {
    Plant plant(bare(0.1));
    plant.place({0, 0, 0}, {0.2, 0, 0});
    plant.advance(0.5, {0, 3, 0}, kNowhere, kNowhere);
    EXPECT_NEAR(plant.position().x, 0.1, 1e-15);
    EXPECT_NEAR(plant.position().y, 0.5 * 30.0 * 0.25, 1e-14);
    EXPECT_NEAR(plant.velocity().y, 15.0, 1e-13);
    EXPECT_NEAR(plant.motorWork(), 3.0 * plant.position().y, 1e-13);
}

TEST(Plant, IsExactForViscousFrictionHoweverLongTheStep) {
    // m x'' = F - b x': v goes to F/b with the time constant m/b, here 1e-3 of the step and 1e3 of it.
    for (const double b : {100.0, 1e-4}) {
        Plant plant(bare(0.1, b));
        const double dt = 1.0, tau = 0.1 / b, force = 2.0;
        plant.place(kNowhere, {0.3, 0, 0});
        plant.advance(dt, {force, 0, 0}, kNowhere, kNowhere);
        const double decay = std::exp(-dt / tau), end = force / b;
        EXPECT_NEAR(plant.velocity().x / (end + (0.3 - end) * decay), 1.0, 1e-9) << b;
        EXPECT_NEAR(plant.position().x / (end * dt + (0.3 - end) * tau * (1.0 - decay)), 1.0, 1e-7) << b;
    }
}

TEST(Plant, OscillatesInTheHandAsTheClosedFormSays) {
    PlantParameters p = bare(0.05);
    p.handMass = 0.05;
    p.handStiffness = 400.0;
    p.handDamping = 2.0;
    Plant plant(p);
    plant.place({0.01, 0, 0}, kNowhere);
    const double m = 0.1, decay = p.handDamping / (2 * m),
                 omega = std::sqrt(p.handStiffness / m - decay * decay);
    for (int tick = 1; tick <= 500; ++tick) {
        plant.advance(1e-3, kNowhere, kNowhere, kNowhere);
        const double t = 1e-3 * tick;
        const double expected =
            0.01 * std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t));
        ASSERT_NEAR(plant.position().x, expected, 1e-14) << tick;
    }
}

TEST(Plant, TrailsBehindAHandThatMovesOn) {
    // At a constant speed w the spring stretches by b w / kh: only the ground's friction holds back.
    PlantParameters p = bare(0.05, 0.5);
    p.handStiffness = 200.0;
    p.handDamping = 4.0;
    Plant plant(p);
    plant.place(kNowhere, kNowhere);
    const double w = 0.2;
    for (int tick = 0; tick < 2000; ++tick)
        plant.advance(1e-3, kNowhere, {w * 1e-3 * tick, 0, 0}, {w * 1e-3 * (tick + 1), 0, 0});
    EXPECT_NEAR(plant.position().x, w * 2.0 - 0.5 * w / 200.0, 1e-12);
    EXPECT_NEAR(plant.velocity().x, w, 1e-12);
}

TEST(Plant, StopsByCoulombFrictionWhereItShouldAndStaysThere) {
    const double mass = 0.075, friction = 0.04, speed = 0.1;
    Plant plant(bare(mass, 0.0, friction));
    const glm::dvec3 direction = glm::normalize(glm::dvec3(1, -2, 0.5));
    plant.place(kNowhere, speed * direction);
    const double way = 0.5 * mass * speed * speed / friction, time = mass * speed / friction;
    for (int tick = 0; tick < static_cast<int>(std::ceil(time / 1e-3)) + 1; ++tick)
        plant.advance(1e-3, kNowhere, kNowhere, kNowhere);
    EXPECT_EQ(plant.velocity(), kNowhere);
    EXPECT_NEAR(glm::dot(plant.position(), direction), way, 1e-9);
    EXPECT_NEAR(plant.coulombLoss(), 0.5 * mass * speed * speed, 1e-15);
    // Under any pull up to fc it stays to the bit.
    const glm::dvec3 rest = plant.position();
    for (int tick = 0; tick < 1000; ++tick)
        plant.advance(1e-3, 0.0399 * glm::dvec3(std::cos(tick), std::sin(tick), 0), kNowhere, kNowhere);
    EXPECT_EQ(plant.position(), rest);
    // And moves under more, with what is left.
    plant.advance(0.01, {0.05, 0, 0}, kNowhere, kNowhere);
    EXPECT_NEAR(plant.velocity().x, 0.01 / mass * 0.01, 1e-12);
}

TEST(Plant, LosesTheSameAmplitudeInEverySwing) {
    // Spring and Coulomb friction: each half swing is 2 fc / k shorter, and it ends within fc / k.
    PlantParameters p = bare(0.05, 0.0, 0.02);
    p.handStiffness = 200.0;
    Plant plant(p);
    plant.place({0.00155, 0, 0}, kNowhere);
    const double loss = 2.0 * 0.02 / 200.0, half = std::numbers::pi * std::sqrt(0.05 / 200.0);
    double swing = 0.00155;
    while (swing > 0.02 / 200.0) {
        plant.advance(half, kNowhere, kNowhere, kNowhere);
        swing -= loss;
        ASSERT_NEAR(std::abs(plant.position().x), std::abs(swing), 1e-8);
    }
    const glm::dvec3 rest = plant.position();
    EXPECT_LT(std::abs(rest.x), 0.02 / 200.0);
    plant.advance(10.0, kNowhere, kNowhere, kNowhere);
    EXPECT_EQ(plant.position(), rest) << "no creep";
    EXPECT_EQ(plant.velocity(), kNowhere);
}

TEST(Plant, NeverGainsEnergy) {
    // Motors and hand at rest: kinetic plus spring energy falls by what friction takes, whatever the step.
    PlantParameters p = bare(0.05, 0.2, 0.05);
    p.handStiffness = 500.0;
    p.handDamping = 1.0;
    Plant plant(p);
    plant.place({0.01, -0.004, 0}, {0, 0.5, -0.3});
    const auto energy = [&] {
        return plant.kineticEnergy() + 250.0 * glm::dot(plant.position(), plant.position());
    };
    double last = energy(), lastLoss = 0.0;
    for (int tick = 0; tick < 400; ++tick) {
        plant.advance(tick % 3 == 0 ? 3.7e-3 : 0.6e-3, kNowhere, kNowhere, kNowhere);
        ASSERT_LE(energy(), last - (plant.coulombLoss() - lastLoss) + 1e-15);
        last = energy();
        lastLoss = plant.coulombLoss();
    }
    EXPECT_EQ(plant.velocity(), kNowhere);
    EXPECT_GT(plant.coulombLoss(), 1e-4);
}

TEST(Plant, BringsMotorWorkToAccount) {
    // Kinetic energy is what the motors gave less what friction took.
    Plant plant(bare(0.08, 0.0, 0.03));
    plant.place(kNowhere, {0.0, 0.2, 0.0});
    for (int tick = 0; tick < 200; ++tick)
        plant.advance(1e-3, {std::sin(0.1 * tick), std::cos(0.07 * tick), 0.3}, kNowhere, kNowhere);
    EXPECT_NEAR(plant.kineticEnergy(), 0.5 * 0.08 * 0.04 + plant.motorWork() - plant.coulombLoss(), 2e-7);
}

TEST(Plant, SaturatesItsMotors) {
    PlantParameters p = bare(0.1);
    p.maxForce = 2.0;
    Plant plant(p);
    plant.place(kNowhere, kNowhere);
    plant.advance(0.1, {30, 40, 0}, kNowhere, kNowhere);
    EXPECT_NEAR(plant.velocity().x, 0.6 * 2.0 / 0.1 * 0.1, 1e-14);
    EXPECT_NEAR(plant.velocity().y, 0.8 * 2.0 / 0.1 * 0.1, 1e-14);
}

TEST(Plant, RefusesWhatIsOutOfRange) {
    for (const auto& info : plantFields()) {
        PlantParameters p;
        EXPECT_EQ(setPlantParameter(p, info.name, std::to_string(info.high)), "");
        EXPECT_EQ(plantParameter(p, info.name), info.high);
        const PlantParameters before = p;
        for (const char* bad : {"-1", "1e9", "nan", "inf", "", "1x", " 1"})
            EXPECT_NE(setPlantParameter(p, info.name, bad).find(info.name), std::string::npos)
                << info.name << "=" << bad;
        EXPECT_EQ(p, before);
    }
    PlantParameters p;
    EXPECT_NE(setPlantParameter(p, "delay", "0.5"), "");
    EXPECT_NE(setPlantParameter(p, "weight", "1").find("handStiffness"), std::string::npos);
    p.mass = -1.0;
    EXPECT_THROW(Plant{p}, Error);
    p = {};
    p.handDamping = NAN;
    EXPECT_THROW(Plant{p}, Error);
}

TEST(HandImpedance, HoldsAForceFromTickToTick) {
    for (const int delay : {0, 1}) {
        PlantParameters p = bare(0.1);
        p.delay = delay;
        ToldHand still;
        still.next.valid = true;
        HandImpedance hand(still, p);
        (void)hand.sample(0.0);
        hand.push({2.0, 0, 0});
        const double first = hand.sample(0.001).position.x;
        hand.push(kNowhere);
        const double second = hand.sample(0.002).position.x;
        // 20 m/s² for the first tick, or one tick later.
        EXPECT_NEAR(first, delay == 0 ? 1e-5 : 0.0, 1e-18);
        EXPECT_NEAR(second, delay == 0 ? 3e-5 : 1e-5, 1e-18);
    }
}

TEST(HandImpedance, IsSeenInTheStepsOfItsSensor) {
    PlantParameters p = bare(0.1);
    p.resolution = 3e-5;
    ToldHand still;
    still.next.valid = true;
    still.next.position = {1.04e-4, -1.04e-4, 1e-5};
    HandImpedance hand(still, p);
    const glm::dvec3 seen = hand.sample(0.0).position;
    EXPECT_NEAR(seen.x, 9e-5, 1e-18);
    EXPECT_NEAR(seen.y, -9e-5, 1e-18);
    EXPECT_EQ(seen.z, 0.0);
    EXPECT_EQ(hand.plant().position(), still.next.position);
}

TEST(HandImpedance, StartsAtRestWhereItIntendsToBe) {
    ToldHand still;
    still.next.valid = true;
    still.next.position = {0.01, 0.02, 0.03};
    HandImpedance hand(still);
    EXPECT_LT(glm::distance(hand.sample(5.0).position, still.next.position), 2.7e-5);
    hand.push({1, 0, 0});
    still.next.valid = false;
    EXPECT_FALSE(hand.sample(5.001).valid);
    still.next = {.position = glm::dvec3(0.1, 0, 0), .valid = true};
    EXPECT_NEAR(hand.sample(5.002).position.x, 0.1, 1.6e-5)
        << "after a gap it begins anew, without the old force";
    EXPECT_NEAR(hand.sample(5.003).position.x, 0.1, 1.6e-5);
    EXPECT_NEAR(hand.sample(5.003).position.x, 0.1, 1.6e-5) << "time stands still";
}

TEST(HandImpedance, AllocatesNothing) {
    ToldHand still;
    still.next.valid = true;
    HandImpedance hand(still);
    const uint64_t before = test::allocationsOnThisThread();
    double moved = 0.0;
    for (int tick = 0; tick < 1000; ++tick) {
        still.next.position.x = 1e-4 * tick;
        moved = hand.sample(1e-3 * tick).position.x;
        hand.push({-0.1, 0, 0});
    }
    EXPECT_EQ(test::allocationsOnThisThread(), before);
    EXPECT_NEAR(moved, 0.0999, 0.003);
}

} // namespace
} // namespace touchstone::plant_test

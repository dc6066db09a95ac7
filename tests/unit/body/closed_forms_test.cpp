// Bodies against mechanics in closed form. Each within 1 % at a tick of 1 ms.

#include "tests/unit/body/body_maker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

namespace touchstone::test {

namespace {

constexpr double kPi = std::numbers::pi;
const BodyIntegrator kAll[] = {BodyIntegrator::Explicit, BodyIntegrator::SemiImplicit,
                               BodyIntegrator::Implicit};

/// 200 g on a spring of `rate` rad/s along x, let go at 2 cm.
BodyMaker spring(double rate) {
    BodyMaker maker;
    const size_t anchor = maker.node("anchor", {0.0, 0.0, 0.0}), mass = maker.node("mass", {0.02, 0.0, 0.0});
    maker.motion(mass, {{"mass", 0.2}, {"inertiaDiagonal", {1e-4, 1e-4, 1e-4}}, {"gravityFactor", 0.0}});
    nlohmann::json joint = BodyMaker::allBut({0});
    joint["drives"] = {
        {{"type", "linear"}, {"mode", "force"}, {"axis", 0}, {"stiffness", 0.2 * rate * rate}}};
    maker.joint(anchor, mass, joint);
    return maker;
}

/// A rod of small inertia that hangs 25 cm below its hinge, turned out by `angle`.
BodyMaker pendulum(double angle) {
    BodyMaker maker;
    const double length = 0.25;
    const size_t anchor = maker.node("anchor", {0.0, 0.0, 0.0});
    const size_t bob = maker.node("bob", {length * std::sin(angle), -length * std::cos(angle), 0.0},
                                  {0.0, 0.0, std::sin(0.5 * angle), std::cos(0.5 * angle)});
    maker.motion(bob, {{"mass", 0.1}, {"inertiaDiagonal", {1e-5, 1e-5, 1e-5}}});
    maker.joint(anchor, maker.child(bob, "end", {0.0, length, 0.0}), BodyMaker::allBut({5}));
    return maker;
}

/// The time of a whole swing: between upward passages of zero, from the first to the last within `seconds`.
template <class Read>
double period(Bodies& bodies, double seconds, BodyIntegrator integrator, Read read) {
    double before = read(), first = -1.0, last = -1.0;
    int swings = -1;
    while (bodies.time < seconds) {
        bodies.step(integrator);
        const double now = read();
        if (before < 0.0 && now >= 0.0) {
            last = bodies.time - bodies.dt * now / (now - before);
            if (++swings == 0)
                first = last;
        }
        before = now;
    }
    return swings > 0 ? (last - first) / swings : NAN;
}

TEST(ClosedForms, AMassOnASpringSwingsWithItsPeriod) {
    for (const BodyIntegrator integrator : kAll) {
        Bodies bodies(spring(20.0));
        const double found =
            period(bodies, 3.0, integrator, [&] { return bodies.at("mass").pose.position.x; });
        std::printf("spring, %s: period %.6f s of %.6f\n", nameOf(integrator), found, 2.0 * kPi / 20.0);
        EXPECT_NEAR(found, 2.0 * kPi / 20.0, 0.01 * 2.0 * kPi / 20.0) << nameOf(integrator);
    }
}

TEST(ClosedForms, EulersExplicitStepGainsOnePlusTheRateSquaredATick) {
    // E(n+1) = E(n) (1 + w^2 dt^2): the eigenvalues of the step are 1 +- i w dt.
    const double rate = 2.0 * kPi, dt = 1e-3;
    for (const BodyIntegrator integrator : kAll) {
        Bodies bodies(spring(rate));
        const double before = bodies.world->energy(0.0);
        bodies.run(60.0, integrator);
        const double ratio = bodies.world->energy(0.0) / before;
        const double gain = std::pow(1.0 + rate * rate * dt * dt, 60000.0);
        std::printf("spring of 1 Hz, 60 s, %s: energy times %.5f (explicit predicts %.5f)\n",
                    nameOf(integrator), ratio, gain);
        const double expected = integrator == BodyIntegrator::Explicit ? gain
                                : integrator == BodyIntegrator::SemiImplicit
                                    ? 1.0
                                    : 1.0 / gain; // 1 / (1 + w^2 dt^2)
        EXPECT_NEAR(ratio, expected, 0.01 * expected);
    }
}

TEST(ClosedForms, APendulumSwingsWithItsPeriod) {
    const double angle = 0.1, inertia = 1e-5 + 0.1 * 0.25 * 0.25;
    const double exact = 2.0 * kPi * std::sqrt(inertia / (0.1 * 9.81 * 0.25)) * (1.0 + angle * angle / 16.0);
    for (const BodyIntegrator integrator : {BodyIntegrator::SemiImplicit, BodyIntegrator::Implicit}) {
        Bodies bodies(pendulum(angle));
        const double begin = bodies.world->energy(9.81);
        const double found =
            period(bodies, 20.0, integrator, [&] { return bodies.at("bob").pose.position.x; });
        std::printf("pendulum, %s: period %.5f s of %.5f, energy %+.3g of %.3g J in 20 s\n",
                    nameOf(integrator), found, exact, bodies.world->energy(9.81) - begin,
                    0.1 * 9.81 * 0.25 * (1.0 - std::cos(angle)));
        EXPECT_NEAR(found, exact, 0.01 * exact) << nameOf(integrator);
        EXPECT_NEAR(glm::length(bodies.at("bob").pose.position), 0.25, 1e-4);
    }
}

/// A block of 4 cm on a slope with friction 0.5.
BodyMaker slope(double degrees) {
    BodyMaker maker;
    const size_t wood = maker.surface(0.5, 0.0);
    const double half = 0.5 * degrees * kPi / 180.0;
    const nlohmann::json turn{0.0, 0.0, std::sin(half), std::cos(half)};
    const glm::dvec3 up{-std::sin(2.0 * half), std::cos(2.0 * half), 0.0};
    const size_t ramp = maker.node("ramp", -0.05 * up, turn);
    maker.box(ramp, {4.0, 0.1, 1.0}, wood);
    const size_t block = maker.node("block", 0.02 * up, turn);
    maker.box(block, {0.04, 0.04, 0.04}, wood);
    maker.motion(block, {{"mass", 0.1}});
    return maker;
}

TEST(ClosedForms, ABlockOnASlopeSlipsAtTheAngleOfFriction) {
    const double limit = std::atan(0.5) * 180.0 / kPi; // 26.565
    for (const double degrees : {limit - 0.25, limit + 0.25}) {
        Bodies bodies(slope(degrees));
        const glm::dvec3 from = bodies.at("block").pose.position;
        bodies.run(2.0);
        const double way = glm::length(bodies.at("block").pose.position - from);
        std::printf("slope of %.3f degrees: %.3f mm in 2 s\n", degrees, 1e3 * way);
        EXPECT_EQ(degrees > limit, way > 0.02);
        EXPECT_TRUE(degrees > limit || way < 2e-4) << way;
    }
    Bodies bodies(slope(35.0));
    const glm::dvec3 from = bodies.at("block").pose.position;
    bodies.run(1.0);
    const double a = 9.81 * (std::sin(35.0 * kPi / 180.0) - 0.5 * std::cos(35.0 * kPi / 180.0));
    const double found = 2.0 * glm::length(bodies.at("block").pose.position - from);
    std::printf("slope of 35 degrees: %.4f m/s^2 of %.4f\n", found, a);
    EXPECT_NEAR(found, a, 0.01 * a);
}

TEST(ClosedForms, BallsCollideElastically) {
    for (const double mass : {0.05, 0.2}) {
        BodyMaker maker;
        const size_t steel = maker.surface(0.0, 1.0);
        const size_t one = maker.node("one", {-0.1, 0.0, 0.0}), other = maker.node("other", {0.1, 0.0, 0.0});
        for (const size_t ball : {one, other})
            maker.ball(ball, 0.02, steel);
        maker.motion(one, {{"mass", 0.1}, {"linearVelocity", {0.5, 0.0, 0.0}}});
        maker.motion(other, {{"mass", mass}, {"linearVelocity", {-0.2, 0.0, 0.0}}});
        Bodies bodies(maker);
        bodies.run(0.6, BodyIntegrator::SemiImplicit, 0.0);
        const double u = (0.1 * 0.5 - mass * 0.2) / (0.1 + mass); // of the common centre
        EXPECT_NEAR(bodies.at("one").velocity.x, 2.0 * u - 0.5, 0.007 * 0.01) << mass;
        EXPECT_NEAR(bodies.at("other").velocity.x, 2.0 * u + 0.2, 0.007 * 0.01) << mass;
        EXPECT_NEAR(bodies.at("one").velocity.y, 0.0, 1e-4);
    }
}

TEST(ClosedForms, AScrewGoesInByItsPitchATurn) {
    BodyMaker maker;
    const size_t anchor = maker.node("anchor", {0.0, 0.0, 0.0}), screw = maker.node("screw", {0.0, 0.0, 0.0});
    maker.motion(
        screw,
        {{"mass", 0.05}, {"inertiaDiagonal", {1e-5, 2e-5, 2e-5}}, {"angularVelocity", {30.0, 0.0, 0.0}}});
    nlohmann::json joint = BodyMaker::allBut({0, 3});
    joint["extensions"]["TOUCHSTONE_joint"] = {{"pitch", 0.002}};
    maker.joint(anchor, screw, joint);
    Bodies bodies(maker);
    bodies.run(2.0, BodyIntegrator::SemiImplicit, 0.0);
    const body::JointReading reading =
        body::BodySolver::reading(bodies.world->solver().joints()[0], bodies.world->states());
    const double turns = reading.position[3] / (2.0 * kPi);
    std::printf("screw: %.4f turns, %.5f mm, %.5f mm a turn\n", turns, 1e3 * reading.position[0],
                1e3 * reading.position[0] / turns);
    EXPECT_GT(std::abs(turns), 5.0);
    EXPECT_NEAR(reading.position[0] / turns, 0.002, 0.01 * 0.002);
}

TEST(ClosedForms, AGyroscopePrecesses) {
    const double spin = 200.0, arm = 0.05, mass = 0.1, axial = 1e-4;
    const double exact = mass * 9.81 * arm / (axial * spin);
    BodyMaker maker;
    const size_t anchor = maker.node("anchor", {0.0, 0.0, 0.0}), wheel = maker.node("wheel", {arm, 0.0, 0.0});
    maker.motion(wheel, {{"mass", mass},
                         {"inertiaDiagonal", {axial, 6e-5, 6e-5}},
                         {"angularVelocity", {spin, exact, 0.0}},
                         {"linearVelocity", {0.0, 0.0, -exact * arm}}});
    maker.joint(anchor, maker.child(wheel, "foot", {-arm, 0.0, 0.0}), BodyMaker::allBut({3, 4, 5}));
    Bodies bodies(maker);
    double turned = 0.0, before = 0.0;
    while (bodies.time < 4.0) {
        bodies.step();
        const glm::dvec3 at = bodies.at("wheel").pose.position;
        const double angle = std::atan2(-at.z, at.x);
        turned += std::remainder(angle - before, 2.0 * kPi);
        before = angle;
        ASSERT_NEAR(glm::length(at), arm, 1e-3);
    }
    std::printf("gyroscope: %.4f rad/s of %.4f\n", turned / 4.0, exact);
    EXPECT_NEAR(turned / 4.0, exact, 0.01 * exact);
}

TEST(ClosedForms, EnergyOver60Seconds) {
    for (const BodyIntegrator integrator : kAll) {
        Bodies swinging(pendulum(0.5));
        const double depth = 0.1 * 9.81 * 0.25, begin = swinging.world->energy(9.81) + depth;
        swinging.run(60.0, integrator);
        const double end = swinging.world->energy(9.81) + depth;

        BodyMaker maker; // a free body that tumbles about its middle axis
        const size_t body = maker.node("body", {0.0, 0.0, 0.0});
        maker.motion(body, {{"mass", 0.1},
                            {"inertiaDiagonal", {1e-5, 2e-5, 2.5e-5}},
                            {"angularVelocity", {0.1, 10.0, 0.1}}});
        Bodies tumbling(maker);
        const double before = tumbling.world->energy(0.0);
        tumbling.run(60.0, integrator, 0.0);
        std::printf("60 s, %s: pendulum of 0.5 rad energy times %.5f, tumbling body times %.5f\n",
                    nameOf(integrator), end / begin, tumbling.world->energy(0.0) / before);
        if (integrator == BodyIntegrator::Explicit)
            continue;
        EXPECT_NEAR(end / begin, 1.0, 0.05) << nameOf(integrator);
        EXPECT_NEAR(tumbling.world->energy(0.0) / before, 1.0, 0.05) << nameOf(integrator);
    }
}

} // namespace

} // namespace touchstone::test

// The friction laws and the cone by themselves: functions of lengths, against their closed forms.

#include "haptics/friction/friction_cone.h"
#include "haptics/friction/friction_law.h"

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace touchstone::friction_law_test {
namespace {

FrictionInput stretched(FrictionState state, double length, double lastLength = 0.0) {
    return {.state = state,
            .stretch = {0.0, length, 0.0},
            .lastLength = lastLength,
            .depth = 2.0,
            .staticFriction = 0.5,
            .dynamicFriction = 0.3};
}

constexpr FrictionState kSticking = FrictionState::Sticking, kSliding = FrictionState::Sliding;

TEST(FrictionLaw, ZillesSticksUpToTheStaticLimitAndSlipsBackToTheDynamicOne) {
    const FrictionAnswer at = zillesLaw(stretched(kSliding, 1.0)); // mu_s N / K = 1
    EXPECT_EQ(at.state, kSticking);
    EXPECT_TRUE(at.stays);
    EXPECT_EQ(at.stretch, glm::dvec3(0.0, 1.0, 0.0));
    const FrictionAnswer beyond = zillesLaw(stretched(kSticking, 1.5));
    EXPECT_EQ(beyond.state, kSliding);
    EXPECT_FALSE(beyond.stays);
    EXPECT_NEAR(glm::length(beyond.stretch - glm::dvec3(0.0, 0.6, 0.0)), 0.0, 1e-15);
    EXPECT_EQ(at.share, 1.0);
    EXPECT_EQ(beyond.share, 1.0);
}

TEST(FrictionLaw, HoHasOneChainAndTwoStiffnesses) {
    for (const double stated : {0.5, 4.0}) {
        FrictionInput in = stretched(kSticking, 0.0);
        in.staticFriction = stated;
        const double soften = std::max(1.0, stated), chain = soften * in.depth;
        in.stretch.y = chain;
        FrictionAnswer answer = hoLaw(in);
        EXPECT_EQ(answer.state, kSticking);
        EXPECT_TRUE(answer.stays);
        EXPECT_DOUBLE_EQ(answer.share, stated / soften);
        in.state = kSliding; // taut: it goes on sliding
        answer = hoLaw(in);
        EXPECT_EQ(answer.state, kSliding);
        EXPECT_DOUBLE_EQ(answer.share, 0.3 / soften);
        in.stretch.y = 0.999 * chain; // slack: it sticks again
        answer = hoLaw(in);
        EXPECT_EQ(answer.state, kSticking);
        EXPECT_DOUBLE_EQ(answer.share, stated / soften);
        in.stretch.y = 3.0 * chain;
        answer = hoLaw(in);
        EXPECT_EQ(answer.state, kSliding);
        EXPECT_FALSE(answer.stays);
        EXPECT_DOUBLE_EQ(answer.stretch.y, chain);
        EXPECT_DOUBLE_EQ(answer.share, 0.3 / soften);
    }
    FrictionInput none = stretched(kSliding, 0.0);
    none.depth = 0.0; // no load, no chain that could be taut
    EXPECT_EQ(hoLaw(none).state, kSticking);
}

/// |x| after one tick in which the stretch grew from `last` to `length`.
double crept(FrictionState state, double length, double last) {
    return elastoplasticLaw(stretched(state, length, last)).stretch.y;
}

TEST(FrictionLaw, TheElastoplasticPointCreepsByTheCosineOfItsShareOfTheLimit) {
    for (const FrictionState state : {kSticking, kSliding}) {
        const double limit = state == kSliding ? 0.6 : 1.0, amplitude = state == kSliding ? 0.5 : 0.25;
        for (const double part : {0.1, 0.25, 0.5, 0.9, 1.0}) {
            const double length = limit * (kElastic + part * (1.0 - kElastic)), growth = 0.01;
            const double alpha = amplitude * (1.0 - std::cos(glm::pi<double>() * part));
            EXPECT_NEAR(crept(state, length, length - growth), length - alpha * growth, 1e-15) << part;
            const FrictionAnswer answer = elastoplasticLaw(stretched(state, length, length - growth));
            EXPECT_EQ(answer.state, state) << part;
            EXPECT_FALSE(answer.stays);
        }
    }
}

TEST(FrictionLaw, TheElastoplasticPointStaysInTheElasticRangeAndWhereTheStretchShrinks) {
    for (const FrictionState state : {kSticking, kSliding}) {
        const double limit = state == kSliding ? 0.6 : 1.0;
        const FrictionAnswer elastic = elastoplasticLaw(stretched(state, 0.99 * kElastic * limit));
        EXPECT_TRUE(elastic.stays);
        EXPECT_EQ(elastic.state, kSticking);
        EXPECT_EQ(elastic.stretch.y, 0.99 * kElastic * limit);
        const FrictionAnswer shrinks = elastoplasticLaw(stretched(state, 0.9 * limit, 0.95 * limit));
        EXPECT_TRUE(shrinks.stays);
        EXPECT_EQ(shrinks.state, state);
        EXPECT_EQ(shrinks.stretch.y, 0.9 * limit);
        EXPECT_EQ(shrinks.share, 1.0);
        const FrictionAnswer beyond = elastoplasticLaw(stretched(state, 1.2, 1.1));
        EXPECT_EQ(beyond.state, kSliding);
        EXPECT_FALSE(beyond.stays);
        EXPECT_DOUBLE_EQ(beyond.stretch.y, 0.6);
        EXPECT_EQ(beyond.share, 1.0);
    }
}

SurfaceSample rough() {
    SurfaceSample feel;
    feel.touching = feel.coulomb = true;
    feel.normal = {0.0, 0.0, 1.0};
    feel.stiffness = 500.0;
    feel.depth = 2e-3; // 1 N
    feel.staticFriction = 0.8;
    feel.dynamicFriction = 0.5;
    return feel;
}

TEST(FrictionCone, OfOneContactLosesWhatTheViscousTermTakes) {
    SurfaceSample feel = rough();
    const FrictionCone dry(feel, {1.0, 0.0, 0.0}, 0.1);
    EXPECT_TRUE(dry.rough());
    EXPECT_FALSE(dry.several());
    EXPECT_DOUBLE_EQ(dry.along({1.0, 0.0, 0.0}).depth, 0.02);
    EXPECT_DOUBLE_EQ(dry.along({1.0, 0.0, 0.0}).staticFriction, 0.8);
    EXPECT_NEAR(glm::length(dry.down() - glm::dvec3(0.0, 0.0, -0.02)), 0.0, 1e-15);
    feel.viscousFriction = 2.0;
    const FrictionCone slow(feel, {0.1, 0.0, -3.0}, 0.1); // 0.2 N along the surface
    EXPECT_NEAR(glm::length(slow.viscousForce() - glm::dvec3(-0.2, 0.0, 0.0)), 0.0, 1e-15);
    EXPECT_NEAR(slow.along({}).staticFriction, 0.6, 1e-15);
    EXPECT_NEAR(slow.along({}).dynamicFriction, 0.3, 1e-15);
    const FrictionCone fast(feel, {1.0, 0.0, 0.0}, 0.1); // no more than mu_d N
    EXPECT_NEAR(glm::length(fast.viscousForce() - glm::dvec3(-0.5, 0.0, 0.0)), 0.0, 1e-15);
    EXPECT_NEAR(fast.along({}).staticFriction, 0.3, 1e-15);
    EXPECT_EQ(fast.along({}).dynamicFriction, 0.0);
}

TEST(FrictionCone, WithoutACoefficientThereIsNoConeAndTheViscousTermIsUnbounded) {
    SurfaceSample feel = rough();
    feel.coulomb = false;
    feel.staticFriction = feel.dynamicFriction = 0.0;
    feel.viscousFriction = 2.0;
    const FrictionCone cone(feel, {5.0, 0.0, 0.0}, 0.1);
    EXPECT_FALSE(cone.rough());
    EXPECT_NEAR(cone.viscousForce().x, -10.0, 1e-12);
    feel.touching = false;
    feel.staticFriction = 1.0;
    EXPECT_FALSE(FrictionCone(feel, glm::dvec3(0.0), 0.1).rough());
    EXPECT_FALSE(FrictionCone().rough());
}

/// Two walls, the floor z = 0 with 1 N on it and the wall x = 0 with 0.5 N.
ContactLoads floorAndWall() {
    ContactLoads loads;
    loads.count = 2;
    for (size_t i = 0; i < 2; ++i) {
        ContactLoad& contact = loads.contacts[i];
        contact.feel = rough();
        contact.feel.normal = contact.surface = contact.plane =
            i == 0 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0);
        contact.length = contact.depth = contact.feel.depth = i == 0 ? 2e-3 : 1e-3;
    }
    loads.stiffness = 500.0;
    loads.offset = {1e-3, 0.0, 2e-3};
    loads.bounding = 1.0;
    return loads;
}

TEST(FrictionCone, OfSeveralContactsBearsTheExtentOfTheirDisks) {
    ContactLoads loads = floorAndWall();
    loads.contacts[1].feel.staticFriction = 0.4;
    loads.contacts[1].feel.dynamicFriction = 0.2;
    const FrictionCone cone(loads, glm::dvec3(0.0), 0.1);
    EXPECT_TRUE(cone.several());
    EXPECT_TRUE(cone.rough());
    EXPECT_EQ(cone.stiffness(), 500.0);
    EXPECT_NEAR(glm::length(cone.down() - glm::dvec3(-0.01, 0.0, -0.02)), 0.0, 1e-15);
    const FrictionCone::Limit groove = cone.along({0.0, 3.0, 0.0}); // both disks in full
    EXPECT_NEAR(groove.depth, 1.5 / 50.0, 1e-15);
    EXPECT_NEAR(groove.staticFriction, (0.8 * 1.0 + 0.4 * 0.5) / 1.5, 1e-15);
    EXPECT_NEAR(groove.dynamicFriction, (0.5 * 1.0 + 0.2 * 0.5) / 1.5, 1e-15);
    const FrictionCone::Limit across = cone.along({2.0, 0.0, 0.0}); // the wall's disk has no extent there
    EXPECT_NEAR(across.depth, 1.0 / 50.0, 1e-15);
    EXPECT_NEAR(across.staticFriction, 0.8, 1e-15);
    const FrictionCone::Limit slanted = cone.along({3.0, 4.0, 0.0});
    EXPECT_NEAR(slanted.depth, (1.0 + 0.5 * 0.8) / 50.0, 1e-15);
    EXPECT_NEAR(cone.along(glm::dvec3(0.0)).depth, 1.5 / 50.0, 1e-15); // no direction: all of it
    loads.contacts[0].feel.staticFriction = loads.contacts[1].feel.staticFriction = 0.0;
    EXPECT_FALSE(FrictionCone(loads, glm::dvec3(0.0), 0.1).rough());
}

TEST(FrictionCone, OfSeveralContactsLosesTheSumOfTheirViscousTerms) {
    ContactLoads loads = floorAndWall();
    for (ContactLoad& contact : loads.contacts)
        contact.feel.viscousFriction = 2.0;
    const FrictionCone cone(loads, {0.0, 0.1, 0.0}, 0.1); // 0.2 N each
    EXPECT_NEAR(glm::length(cone.viscousForce() - glm::dvec3(0.0, -0.4, 0.0)), 0.0, 1e-15);
    const FrictionCone::Limit limit = cone.along({0.0, 1.0, 0.0});
    EXPECT_NEAR(limit.staticFriction, (0.8 * 1.5 - 0.4) / 1.5, 1e-15);
    EXPECT_NEAR(limit.dynamicFriction, (0.5 * 1.5 - 0.4) / 1.5, 1e-15);
    const FrictionCone fast(loads, {0.0, 9.0, 0.0}, 0.1); // mu_d N of each
    EXPECT_NEAR(glm::length(fast.viscousForce() - glm::dvec3(0.0, -0.75, 0.0)), 0.0, 1e-15);
    EXPECT_NEAR(fast.along({0.0, 1.0, 0.0}).dynamicFriction, 0.0, 1e-15);
    loads.contacts[0].feel.depth = loads.contacts[1].feel.depth = 0.0; // no load, no friction
    EXPECT_EQ(FrictionCone(loads, glm::dvec3(0.0), 0.1).along({0.0, 1.0, 0.0}).depth, 0.0);
}

} // namespace
} // namespace touchstone::friction_law_test

#include "haptics/tick/haptic_step.h"
#include "haptics/world/world_state.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace touchstone {
namespace {

/// A square of 0.1 m in y = 0, seen from above, on a node with a parent.
Scene squareOnTwoNodes() {
    Scene scene;
    Mesh mesh;
    mesh.positions = {
        {-0.05f, 0.0f, -0.05f}, {-0.05f, 0.0f, 0.05f}, {0.05f, 0.0f, 0.05f}, {0.05f, 0.0f, -0.05f}};
    mesh.normals.assign(4, {0.0f, 1.0f, 0.0f});
    mesh.indices = {0, 1, 2, 0, 2, 3};
    scene.meshes.push_back(std::move(mesh));
    scene.materials.emplace_back();
    scene.nodes.resize(2);
    scene.nodes[1].parent = 0;
    scene.instances.push_back({.node = 1, .mesh = 0});
    return scene;
}

AnimationChannel channel(int node, AnimatedPath path, std::vector<float> times,
                         std::vector<glm::vec4> values) {
    AnimationChannel made;
    made.node = node;
    made.path = path;
    made.times = std::move(times);
    made.values = std::move(values);
    return made;
}

struct Moved {
    explicit Moved(Scene described, const Similarity& workspaceFromScene = {})
        : scene(std::make_shared<const Scene>(std::move(described))),
          haptic(compileHapticScene(*scene, workspaceFromScene)), world(scene, *haptic) {}

    ScenePtr scene;
    std::shared_ptr<const HapticScene> haptic;
    WorldState world;
};

TEST(WorldState, NothingMovesWithoutAnAnimationOfATouchableNode) {
    Moved still(squareOnTwoNodes());
    EXPECT_FALSE(still.world.moving());
    EXPECT_TRUE(still.world.advance(1.0).empty());

    Scene scene = squareOnTwoNodes();
    scene.nodes.emplace_back(); // a node of its own: a camera, say
    scene.animations.push_back(
        {"camera",
         1.0,
         {channel(2, AnimatedPath::Translation, {0.0f, 1.0f}, {glm::vec4(0.0f), glm::vec4(1.0f)})}});
    EXPECT_FALSE(Moved(std::move(scene)).world.moving());
}

TEST(WorldState, FollowsAParentsTranslationInTheWorkspaceAndRemembersTheTickBefore) {
    Scene scene = squareOnTwoNodes();
    scene.animations.push_back({"lift",
                                1.0,
                                {channel(0, AnimatedPath::Translation, {0.0f, 1.0f},
                                         {glm::vec4(0.0f), glm::vec4(0.0f, 0.2f, 0.0f, 0.0f)})}});
    Moved moved(std::move(scene), {.scale = 0.5});
    ASSERT_TRUE(moved.world.moving());
    const ObjectMotion rest = moved.haptic->restMotions[0];
    ObjectMotion now = moved.world.advance(0.25)[0];
    EXPECT_NEAR(now.workspaceFromObject.translation.y - rest.workspaceFromObject.translation.y, 0.025, 1e-9);
    EXPECT_NEAR(now.workspaceFromObject.scale, rest.workspaceFromObject.scale, 1e-12);
    EXPECT_EQ(now.before.translation.y, now.workspaceFromObject.translation.y)
        << "the first tick did not come from afar";
    const double before = now.workspaceFromObject.translation.y;
    now = moved.world.advance(0.5)[0];
    EXPECT_NEAR(now.workspaceFromObject.translation.y - before, 0.025, 1e-9);
    EXPECT_EQ(now.before.translation.y, before);
    EXPECT_NEAR(moved.world.advance(7.25)[0].workspaceFromObject.translation.y, before, 1e-7)
        << "plays again";
}

TEST(WorldState, AnAnimationThatEndsElsewhereThanItBeginsJumpsWhenItBeginsAgain) {
    for (const float end : {0.2f, 0.0f}) {
        Scene scene = squareOnTwoNodes();
        scene.animations.push_back({"lift",
                                    1.0,
                                    {channel(0, AnimatedPath::Translation, {0.0f, 0.5f, 1.0f},
                                             {glm::vec4(0.0f), glm::vec4(0.0f, 0.2f, 0.0f, 0.0f),
                                              glm::vec4(0.0f, end, 0.0f, 0.0f)})}});
        Moved moved(std::move(scene));
        EXPECT_FALSE(moved.world.advance(0.9)[0].jumped);
        EXPECT_FALSE(moved.world.advance(0.999)[0].jumped);
        EXPECT_EQ(moved.world.advance(1.001)[0].jumped, end != 0.0f);
        EXPECT_FALSE(moved.world.advance(1.002)[0].jumped);
    }
}

TEST(WorldState, FollowsRotationAndEvenScale) {
    const float half = std::sqrt(0.5f);
    Scene scene = squareOnTwoNodes();
    scene.animations.push_back(
        {"turn and grow",
         1.0,
         {channel(1, AnimatedPath::Rotation, {0.0f, 1.0f},
                  {glm::vec4(0.0f, 0.0f, half, half), glm::vec4(0.0f, 0.0f, half, half)}),
          channel(1, AnimatedPath::Scale, {0.0f, 1.0f},
                  {glm::vec4(2.0f, 2.0f, 2.0f, 0.0f), glm::vec4(2.0f, 2.0f, 2.0f, 0.0f)})}});
    EXPECT_TRUE(animationWarnings(scene).empty()) << "an even scale is followed as it is";
    Moved moved(std::move(scene));
    const Similarity rest = moved.haptic->restMotions[0].workspaceFromObject;
    const Similarity now = moved.world.advance(0.5)[0].workspaceFromObject;
    EXPECT_NEAR(now.scale, 2.0 * rest.scale, 1e-7);
    // A corner at (0.05, 0, z) turns a quarter about z to (0, 0.05, z), twice as far out.
    const glm::dvec3 corner = rest.inverse().point({0.05, 0.0, 0.02});
    EXPECT_NEAR(glm::length(now.point(corner) - glm::dvec3(0.0, 0.1, 0.04)), 0.0, 1e-7);
}

TEST(WorldState, AMirroringPoseLeavesTheObjectWhereItWas) {
    Scene scene = squareOnTwoNodes();
    scene.animations.push_back({"flip",
                                1.0,
                                {channel(1, AnimatedPath::Scale, {0.0f, 1.0f},
                                         {glm::vec4(1.0f), glm::vec4(-1.0f, 1.0f, 1.0f, 0.0f)})}});
    Moved moved(std::move(scene));
    const Similarity now = moved.world.advance(0.9)[0].workspaceFromObject;
    EXPECT_TRUE(std::isfinite(now.scale) && now.scale > 0.0);
    EXPECT_TRUE(std::isfinite(now.translation.y));
}

TEST(WorldState, AnUnevenScaleIsTold) {
    Scene scene = squareOnTwoNodes();
    scene.animations.push_back({"squash",
                                1.0,
                                {channel(1, AnimatedPath::Scale, {0.0f, 1.0f},
                                         {glm::vec4(1.0f), glm::vec4(1.0f, 0.5f, 1.0f, 0.0f)})}});
    EXPECT_EQ(animationWarnings(scene).size(), 1u);
    scene.animations.emplace_back();
    EXPECT_EQ(animationWarnings(scene).size(), 2u) << "and that only the first plays";
    EXPECT_TRUE(animationWarnings(squareOnTwoNodes()).empty());
}

TEST(WorldState, AnAnimationThatMovesNothingHidesNoOther) {
    Scene scene = squareOnTwoNodes();
    scene.animations.push_back({"smile", 1.0, {}}); // of morph weights, say, which are left out
    scene.animations.push_back({"squash",
                                1.0,
                                {channel(1, AnimatedPath::Scale, {0.0f, 1.0f},
                                         {glm::vec4(1.0f), glm::vec4(1.0f, 0.5f, 1.0f, 0.0f)})}});
    const std::vector<Warning> warnings = animationWarnings(scene);
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_NE(warnings[0].message.find("'squash'"), std::string::npos) << warnings[0].message;
    EXPECT_EQ(warnings[1].place, "animations[1]");
    EXPECT_TRUE(Moved(std::move(scene)).world.moving());
}

/// A million objects at the end of a chain of a thousand nodes, beside three thousand channels: asked one by
/// one up the chain it is an hour.
TEST(WorldState, WhatMovesIsFoundInLittleMoreThanTheNumberOfNodesChannelsAndObjects) {
    constexpr size_t kDepth = 1000, kObjects = 1'000'000;
    Scene described = squareOnTwoNodes();
    described.nodes.resize(2 * kDepth);
    for (size_t n = 1; n < kDepth; ++n)
        described.nodes[n].parent = static_cast<int>(n) - 1;
    described.instances = {{.node = kDepth - 1, .mesh = 0}, {.node = 2 * kDepth - 1, .mesh = 0}};
    Animation animation{"many", 1.0, {}};
    for (size_t n = kDepth; n < 2 * kDepth; ++n)
        for (const AnimatedPath path :
             {AnimatedPath::Translation, AnimatedPath::Rotation, AnimatedPath::Scale})
            animation.channels.push_back(channel(static_cast<int>(n), path, {0.0f}, {glm::vec4(1.0f)}));
    described.animations.push_back(std::move(animation));
    const auto scene = std::make_shared<const Scene>(std::move(described));
    const auto standing = std::make_shared<HapticObject>(), moved = std::make_shared<HapticObject>();
    standing->instance = 0;
    moved->instance = 1;
    HapticScene haptic;
    haptic.objects.assign(kObjects, standing);
    haptic.restMotions.resize(kObjects);
    EXPECT_FALSE(WorldState(scene, haptic).moving());
    haptic.objects.back() = moved;
    EXPECT_TRUE(WorldState(scene, haptic).moving());
}

/// A floor that rises through a hand at rest carries the proxy up with it and pushes.
TEST(WorldState, ARisingFloorPushesARestingHand) {
    Scene scene = squareOnTwoNodes();
    scene.animations.push_back({"rise",
                                1.0,
                                {channel(1, AnimatedPath::Translation, {0.0f, 1.0f},
                                         {glm::vec4(0.0f), glm::vec4(0.0f, 0.02f, 0.0f, 0.0f)})}});
    Moved moved(std::move(scene));
    HapticSettings settings;
    settings.stiffness = 500.0;
    DeviceState state;
    HapticOutput output;
    DeviceSample sample;
    sample.position = {0.01, 0.01, 0.01};
    sample.valid = true;
    NoStopwatch none;
    for (int i = 0; i <= 800; ++i) {
        TickInput input;
        input.tick = static_cast<uint64_t>(i);
        input.time = 1e-3 * i;
        input.hands = {&sample, 1};
        moved.world.advance(input.time);
        hapticStep(*moved.haptic, settings, input, moved.world, {&state, 1}, {&output, 1}, none);
        const double floor = 0.02 * input.time, depth = floor - sample.position.y;
        if (depth < -1e-6) {
            EXPECT_EQ(output.contacts, 0u) << i;
        } else if (depth > 1e-6) {
            EXPECT_NEAR(output.force.y, settings.stiffness * (depth + settings.proxyRadius), 1e-4) << i;
            EXPECT_NEAR(output.proxy.y, floor + settings.proxyRadius, 1e-7) << i;
        }
    }
    EXPECT_GT(output.force.y, 2.9);
}

/// The square on its second node moves from one pose to another within a second; whether that is a jump.
bool jumps(AnimatedPath path, const glm::vec4& from, const glm::vec4& to) {
    Scene scene = squareOnTwoNodes();
    scene.animations.push_back({"goes on", 1.0, {channel(1, path, {0.0f, 1.0f}, {from, to})}});
    Moved moved(std::move(scene));
    (void)moved.world.advance(0.9);
    return moved.world.advance(1.1)[0].jumped;
}

TEST(WorldState, ALapThatEndsWithinAThousandthOfWhereItBeganIsNoJump) {
    const glm::vec4 far(3.0f, 4.0f, -5.0f, 0.0f); // whose longest side, 0.1, is the unit
    EXPECT_FALSE(jumps(AnimatedPath::Translation, far, far));
    EXPECT_FALSE(jumps(AnimatedPath::Translation, far, far + glm::vec4(0.0f, 5e-5f, 0.0f, 0.0f)));
    EXPECT_TRUE(jumps(AnimatedPath::Translation, far, far + glm::vec4(0.0f, 5e-4f, 0.0f, 0.0f)));
    const auto turned = [](double angle) {
        return glm::vec4(0.0f, static_cast<float>(std::sin(0.5 * angle)), 0.0f,
                         static_cast<float>(std::cos(0.5 * angle)));
    };
    EXPECT_FALSE(jumps(AnimatedPath::Rotation, turned(0.7), turned(0.7)));
    EXPECT_FALSE(jumps(AnimatedPath::Rotation, turned(0.7), -turned(0.7))) << "the same turn";
    EXPECT_TRUE(jumps(AnimatedPath::Rotation, turned(0.7), turned(0.71)));
    EXPECT_TRUE(jumps(AnimatedPath::Rotation, turned(0.0), turned(0.5)));
    EXPECT_FALSE(jumps(AnimatedPath::Scale, glm::vec4(1.0f), glm::vec4(1.0f)));
    EXPECT_TRUE(jumps(AnimatedPath::Scale, glm::vec4(1.0f), glm::vec4(1.01f)));
}

TEST(WorldState, TheFirstNodeMovesAsAnyOther) {
    Scene scene = squareOnTwoNodes();
    scene.instances[0].node = 0;
    scene.animations.push_back({"lift",
                                1.0,
                                {channel(0, AnimatedPath::Translation, {0.0f, 1.0f},
                                         {glm::vec4(0.0f), glm::vec4(0.0f, 0.2f, 0.0f, 0.0f)})}});
    EXPECT_TRUE(animationWarnings(scene).empty()) << "one animation, and it plays";
    scene.animations.push_back(scene.animations[0]);
    EXPECT_EQ(animationWarnings(scene).size(), 1u) << "of two only one plays";
    Moved moved(std::move(scene));
    ASSERT_TRUE(moved.world.moving());
    EXPECT_NEAR(moved.world.advance(0.5)[0].workspaceFromObject.translation.y, 0.1, 1e-7);
}

} // namespace
} // namespace touchstone

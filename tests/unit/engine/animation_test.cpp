#include "engine/scene/animation.h"
#include "tests/unit/engine/load_support.h"

#include <cmath>

namespace touchstone::animation_test {
namespace {

using test::GltfMaker;
using test::load;

AnimationChannel channelOf(Interpolation interpolation, AnimatedPath path, std::vector<float> times,
                           std::vector<glm::vec4> values) {
    AnimationChannel channel;
    channel.node = 0;
    channel.path = path;
    channel.interpolation = interpolation;
    channel.times = std::move(times);
    channel.values = std::move(values);
    return channel;
}

glm::vec4 aboutZ(double angle) {
    return glm::vec4(0.0, 0.0, std::sin(angle / 2), std::cos(angle / 2));
}

double angleAboutZ(const glm::dvec4& q) {
    return 2.0 * std::atan2(q.z, q.w);
}

TEST(Animation, StepHoldsTheLastKey) {
    const auto channel = channelOf(Interpolation::Step, AnimatedPath::Translation, {1, 2, 4},
                                   {{1, 0, 0, 0}, {2, 0, 0, 0}, {3, 0, 0, 0}});
    EXPECT_EQ(sampleChannel(channel, 0.0).x, 1.0);
    EXPECT_EQ(sampleChannel(channel, 1.999).x, 1.0);
    EXPECT_EQ(sampleChannel(channel, 2.0).x, 2.0);
    EXPECT_EQ(sampleChannel(channel, 3.999).x, 2.0);
    EXPECT_EQ(sampleChannel(channel, 9.0).x, 3.0);
}

TEST(Animation, LinearMovesEvenly) {
    const auto channel =
        channelOf(Interpolation::Linear, AnimatedPath::Translation, {1, 3}, {{0, 10, 0, 0}, {4, 10, -2, 0}});
    for (double t = 1.0; t <= 3.0; t += 0.125) {
        const double s = (t - 1.0) / 2.0;
        EXPECT_NEAR(glm::length(glm::dvec3(sampleChannel(channel, t)) - glm::dvec3(4 * s, 10, -2 * s)), 0.0,
                    1e-12);
    }
}

TEST(Animation, LinearRotationsTurnAtOneSpeedTheShortWay) {
    for (const double sign : {1.0, -1.0}) { // q and -q are the same rotation
        const auto channel = channelOf(Interpolation::Linear, AnimatedPath::Rotation, {0, 1},
                                       {aboutZ(0.2), glm::vec4(sign * glm::dvec4(aboutZ(1.4)))});
        for (double t = 0.0; t <= 1.0; t += 0.0625)
            EXPECT_NEAR(
                std::remainder(angleAboutZ(sampleChannel(channel, t)) - (0.2 + 1.2 * t), 4 * std::acos(0.0)),
                0.0, 1e-6);
    }
}

TEST(Animation, CubicSplinesAreHermiteCurves) {
    // x(t) = t^3 - 2 t + 5 between the keys 1 and 3 is itself a cubic, so it must come back exactly.
    const auto x = [](double t) { return t * t * t - 2 * t + 5; };
    const auto slope = [](double t) { return 3 * t * t - 2; };
    const auto v = [](double value) { return glm::vec4(static_cast<float>(value), 0, 0, 0); };
    const auto channel = channelOf(Interpolation::CubicSpline, AnimatedPath::Scale, {1, 3},
                                   {v(-99), v(x(1)), v(slope(1)), v(slope(3)), v(x(3)), v(-99)});
    for (double t = 1.0; t <= 3.0; t += 0.1)
        EXPECT_NEAR(sampleChannel(channel, t).x, x(t), 1e-12);
    EXPECT_EQ(sampleChannel(channel, 0.0).x, x(1)); // clamped to the value, never to a tangent
    EXPECT_EQ(sampleChannel(channel, 8.0).x, x(3));
}

TEST(Animation, CubicRotationsComeOutUnit) {
    const glm::vec4 none(0.0f), tangent(0.3f, -0.2f, 0.4f, 0.1f);
    const auto channel = channelOf(Interpolation::CubicSpline, AnimatedPath::Rotation, {0, 1},
                                   {none, aboutZ(0.0), tangent, tangent, aboutZ(2.0), none});
    for (double t = 0.0; t <= 1.0; t += 0.05)
        EXPECT_NEAR(glm::length(sampleChannel(channel, t)), 1.0, 1e-14);
}

TEST(Animation, InstancesFollowTheirNodesAndParents) {
    GltfMaker maker = GltfMaker::square();
    maker.json["nodes"] = {{{"children", {1}}}, {{"mesh", 0}, {"translation", {2, 0, 0}}}};
    const size_t times = maker.addAccessor<float>({0, 2}, "SCALAR");
    const size_t turns = maker.addAccessor<int16_t>({0, 0, 0, 32767, 0, 0, 23170, 23170}, "VEC4", true);
    maker.json["animations"] = {
        {{"name", "turn"},
         {"samplers", {{{"input", times}, {"output", turns}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}}}}};
    const ScenePtr scene = load(maker);
    ASSERT_EQ(scene->animations.size(), 1u);
    const Animation& animation = scene->animations[0];
    EXPECT_EQ(animation.duration, 2.0);
    ScenePose pose(*scene);
    EXPECT_EQ(pose.sceneFromMesh()[0], scene->instances[0].sceneFromMesh);
    for (double t = 0.0; t <= 2.0; t += 0.25) {
        pose.evaluate(*scene, &animation, t);
        const double angle = std::acos(0.0) * t / 2.0;
        const glm::dvec3 place(pose.sceneFromMesh()[0][3]);
        EXPECT_NEAR(glm::length(place - 2.0 * glm::dvec3(std::cos(angle), std::sin(angle), 0)), 0.0, 1e-4)
            << t; // 16-bit keys
        EXPECT_EQ(sceneFromMeshAt(*scene, &animation, t)[0], pose.sceneFromMesh()[0]);
    }
    pose.evaluate(*scene, nullptr, 1.0);
    EXPECT_EQ(pose.sceneFromMesh()[0], scene->instances[0].sceneFromMesh);
    EXPECT_NEAR(loopedTime(animation, 5.0), 1.0, 1e-12);
    EXPECT_NEAR(loopedTime(animation, -0.5), 1.5, 1e-12);
}

GltfMaker animated(const std::vector<float>& times, const std::vector<float>& values, const char* type,
                   const char* path) {
    GltfMaker maker = GltfMaker::square();
    const size_t input = maker.addAccessor<float>(times, "SCALAR"),
                 output = maker.addAccessor<float>(values, type);
    maker.json["animations"] = {
        {{"samplers", {{{"input", input}, {"output", output}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}}};
    return maker;
}

TEST(Animation, BrokenOnesAreMendedOrLeftOutWithTheirPlace) {
    const std::string input = "animations[0].samplers[0].input", output = "animations[0].samplers[0].output";
    EXPECT_MENDED(animated({0, 0}, {0, 0, 0, 1, 1, 1}, "VEC3", "translation"), input,
                  "not after the one before");
    EXPECT_MENDED(animated({-1, 0}, {0, 0, 0, 1, 1, 1}, "VEC3", "translation"), input, "negative");
    EXPECT_MENDED(animated({0, NAN}, {0, 0, 0, 1, 1, 1}, "VEC3", "translation"), input, "finite");
    EXPECT_MENDED(animated({0, 1}, {0, 0, 0, 1, INFINITY, 1}, "VEC3", "translation"), output,
                  "value 1 is not finite");
    EXPECT_MENDED(animated({0, 1}, {0, 0, 0}, "VEC3", "translation"), output, "1 values where 2");
    EXPECT_MENDED(animated({0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3", "rotation"), output, "4 components");
    EXPECT_MENDED(animated({0, 1}, {0, 0, 0, 1, 0, 0, 0.3f, 0.3f}, "VEC4", "rotation"), output,
                  "1 rotations are not of unit length");
    GltfMaker matrix = animated({0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3", "translation");
    matrix.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    EXPECT_MENDED(matrix, "animations[0].channels[0].target.node", "has a matrix");
    GltfMaker sampler = animated({0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3", "translation");
    sampler.json["animations"][0]["channels"][0]["sampler"] = 1;
    EXPECT_MENDED(sampler, "animations[0].channels[0].sampler", "does not exist");
}

TEST(Animation, KeysThatDoNotAscendAreSkippedAndRotationsNormalised) {
    const GltfMaker maker =
        animated({-1, 0, 0, 1}, {0, 0, 0, 2, 0, 0, 0, 4, 9, 9, 9, 9, 0, 0, 3, 4}, "VEC4", "rotation");
    const ScenePtr scene = load(maker);
    ASSERT_EQ(scene->animations.at(0).channels.size(), 1u);
    const AnimationChannel& channel = scene->animations[0].channels[0];
    EXPECT_EQ(channel.times, (std::vector<float>{-1, 0, 1}));
    ASSERT_EQ(channel.values.size(), 3u);
    EXPECT_EQ(channel.values[0], glm::vec4(0, 0, 0, 1));
    EXPECT_EQ(channel.values[1], glm::vec4(0, 0, 0, 1));
    EXPECT_EQ(channel.values[2], glm::vec4(0, 0, 0.6f, 0.8f));
    EXPECT_EQ(scene->animations[0].duration, 1.0);
    EXPECT_TRUE(
        test::warns(*scene, "animations[0].samplers[0].input", "1 times are not after the one before"));
    EXPECT_TRUE(test::warns(*scene, "animations[0].samplers[0].output", "not of unit length"));
}

TEST(Animation, AllKeysBeforeZeroDoNotPlayBackwards) {
    const ScenePtr scene = load(animated({-3, -1}, {0, 0, 0, 1, 1, 1}, "VEC3", "translation"));
    EXPECT_EQ(scene->animations.at(0).duration, 0.0);
    EXPECT_EQ(sampleChannel(scene->animations[0].channels.at(0), 0.0), glm::dvec4(1, 1, 1, 0));
}

TEST(Animation, OneTargetIsAnimatedOnce) {
    GltfMaker maker = animated({0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3", "translation");
    maker.json["animations"][0]["channels"].push_back(maker.json["animations"][0]["channels"][0]);
    EXPECT_MENDED(maker, "animations[0].channels[1].target", "earlier channel");
    EXPECT_EQ(load(maker)->animations.at(0).channels.size(), 1u);
}

TEST(Animation, AMalformedOneIsLeftOutWhole) {
    GltfMaker maker = animated({0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3", "translation");
    maker.json["animations"][0]["channels"][0]["target"]["node"] = 7;
    EXPECT_MENDED(maker, "animations[0].channels[0].target.node", "left out");
    EXPECT_TRUE(load(maker)->animations.at(0).channels.empty());
    maker.json["animations"] = "none";
    EXPECT_MENDED(maker, "animations", "should be an array");
}

TEST(Animation, TheFirstThatMovesANodePlays) {
    GltfMaker maker = animated({0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3", "translation");
    const nlohmann::json moving = maker.json["animations"][0];
    nlohmann::json weights = moving;
    weights["channels"][0]["target"]["path"] = "weights";
    maker.json["animations"] = {weights, moving, moving};
    const ScenePtr scene = load(maker);
    ASSERT_EQ(scene->animations.size(), 3u);
    EXPECT_EQ(playedAnimation(*scene), &scene->animations[1]);
    maker.json["animations"] = {weights};
    EXPECT_EQ(playedAnimation(*load(maker)), nullptr);
}

TEST(Animation, OneThatMovesNoInstanceGivesWayToOneThatDoes) {
    GltfMaker maker = animated({0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3", "translation");
    const auto joint = static_cast<int>(maker.json["nodes"].size());
    maker.json["nodes"].push_back({{"name", "joint"}});
    maker.json["scenes"][0]["nodes"].push_back(joint);
    const nlohmann::json moving = maker.json["animations"][0];
    nlohmann::json ofJoint = moving;
    ofJoint["channels"][0]["target"]["node"] = joint;
    maker.json["animations"] = {ofJoint, moving};
    const ScenePtr scene = load(maker);
    EXPECT_EQ(playedAnimation(*scene), &scene->animations.at(1));
    maker.json["animations"] = {ofJoint};
    const ScenePtr alone = load(maker);
    EXPECT_EQ(playedAnimation(*alone), &alone->animations.at(0));
}

TEST(Animation, WeightsOfANodeWithoutTargetsAreLeftOutWithAWarning) {
    const ScenePtr scene = load(animated({0, 1}, {0, 1}, "SCALAR", "weights"));
    EXPECT_TRUE(scene->animations.at(0).channels.empty());
    EXPECT_TRUE(test::warns(*scene, "animations[0]", "morph"));
}

} // namespace
} // namespace touchstone::animation_test

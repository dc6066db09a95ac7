// Buttons, switches, sliders and knobs that set settings.

#include "haptics/body/joint_settings.h"
#include "tests/support/recorded_servo.h"
#include "tests/unit/body/body_maker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace touchstone::test {

namespace {

/// The panel of assets/scenes, whose parts a test puts where it wants them.
struct Panel {
    Panel() : scene(touchedScene("panel.glb")), world(body::BodyWorld::make(*scene.source, *scene.haptic)) {
        for (const body::BodyState& state : world->states())
            poses.push_back(state.pose);
        controls = body::JointSettings(*world);
        rest = poses;
        (void)controls.apply(poses, settings);
    }
    [[nodiscard]] size_t at(const std::string& name) const {
        return static_cast<size_t>(std::ranges::find(world->names(), name) - world->names().begin());
    }
    bool slide(const std::string& name, const glm::dvec3& way) {
        poses[at(name)].position = rest[at(name)].position + scene.haptic->workspaceFromScene.scale * way;
        return controls.apply(poses, settings);
    }
    bool turn(const std::string& name, double angle, const glm::dvec3& axis) {
        body::Pose& pose = poses[at(name)];
        pose = rest[at(name)];
        pose.rotation = glm::angleAxis(angle, axis) * pose.rotation;
        return controls.apply(poses, settings);
    }

    TouchedScene scene;
    std::shared_ptr<body::BodyWorld> world;
    body::JointSettings controls;
    std::vector<body::Pose> poses, rest;
    HapticSettings settings;
};

TEST(JointSettings, NothingChangesBeforeAControlMoves) {
    Panel panel;
    ASSERT_FALSE(panel.controls.empty());
    EXPECT_EQ(panel.settings, HapticSettings{});
    EXPECT_FALSE(panel.controls.apply(panel.poses, panel.settings));
    EXPECT_EQ(panel.settings, HapticSettings{});
}

TEST(JointSettings, ASliderSetsANumberOfItsRange) {
    Panel panel;
    EXPECT_TRUE(panel.slide("slider", {0.0, 0.0, 0.024}));
    EXPECT_NEAR(panel.settings.stiffness, 200.0, 1e-6);
    EXPECT_TRUE(panel.slide("slider", {0.0, 0.0, -0.024}));
    EXPECT_NEAR(panel.settings.stiffness, 1500.0, 1e-6);
    EXPECT_TRUE(panel.slide("slider", {0.0, 0.0, 0.0}));
    EXPECT_NEAR(panel.settings.stiffness, 850.0, 15.0);
    EXPECT_FALSE(panel.slide("slider", {0.0, 0.0, 0.0003})) << "less than a part of its range";
}

TEST(JointSettings, ASwitchHasOneValueAtEachEnd) {
    Panel panel;
    (void)panel.turn("switch", -0.35, {0.0, 0.0, 1.0});
    EXPECT_TRUE(panel.turn("switch", 0.35, {0.0, 0.0, 1.0}));
    EXPECT_EQ(panel.settings.texture, TextureMode::Off);
    EXPECT_FALSE(panel.turn("switch", 0.0, {0.0, 0.0, 1.0})) << "half way is not the other end";
    EXPECT_TRUE(panel.turn("switch", -0.3, {0.0, 0.0, 1.0}));
    EXPECT_EQ(panel.settings.texture, TextureMode::Law);
}

TEST(JointSettings, AKnobGoesFromDetentToDetent) {
    Panel panel;
    for (int i = -5; i <= 5; ++i) { // from the middle, where it is at first
        (void)panel.turn("knob", i * std::numbers::pi / 6.0, {0.0, 1.0, 0.0});
        EXPECT_NEAR(panel.settings.textureStrength, 0.5 - 0.1 * i, 1e-9) << i;
    }
}

TEST(JointSettings, AButtonStepsEachTimeItIsPressed) {
    Panel panel;
    for (const FrictionMode expected : {FrictionMode::Off, FrictionMode::Zilles, FrictionMode::Off}) {
        EXPECT_TRUE(panel.slide("button", {0.0, -0.0039, 0.0}));
        EXPECT_EQ(panel.settings.friction, expected);
        EXPECT_FALSE(panel.slide("button", {0.0, -0.003, 0.0}));
        EXPECT_FALSE(panel.slide("button", {0.0, -0.0001, 0.0}));
        EXPECT_EQ(panel.settings.friction, expected);
    }
}

/// A box on a slider.
BodyMaker slider(const nlohmann::json& ours) {
    BodyMaker maker;
    (void)maker.surface(0.4, 0.0);
    const size_t box = maker.node("box", {0.0, 0.0, 0.0});
    maker.box(box, glm::dvec3(0.02), 0);
    maker.motion(box, {{"mass", 0.1}});
    nlohmann::json joint = BodyMaker::allBut({0});
    joint["limits"].push_back({{"linearAxes", {0}}, {"min", -0.02}, {"max", 0.02}});
    joint["extensions"]["TOUCHSTONE_joint"] = ours;
    (void)maker.joint(maker.node("base", {0.0, 0.0, 0.0}), box, std::move(joint));
    return maker;
}

TEST(JointSettings, WhatIsNoSettingIsLeftOutWithAMessage) {
    struct Case {
        nlohmann::json ours;
        const char* message;
        bool joined; // the joint itself is kept
    };
    for (const Case& c :
         {Case{{{"setting", "stiffness"}, {"from", 100.0}, {"to", 900.0}}, "", true},
          Case{{{"setting", "colour"}, {"values", {"red", "blue"}}}, "no setting 'colour'", true},
          Case{{{"setting", "texture"}, {"values", {"law", "loud"}}}, "loud", true},
          Case{{{"setting", "stiffness"}, {"from", -5.0}, {"to", 900.0}}, "stiffness", true},
          Case{{{"setting", 3}}, "name of a setting", false},
          Case{{{"setting", "texture"}, {"values", {"law"}}}, "2 to 1024", false},
          Case{{{"setting", "texture"}, {"values", {true, false}}}, "words or numbers", false},
          Case{{{"setting", "texture"}, {"press", true}}, "'values'", false},
          Case{{{"setting", "stiffness"}}, "neither", false}}) {
        const BodyMaker maker = slider(c.ours);
        const ScenePtr scene = maker.scene();
        const auto haptic = compileHapticScene(*scene, Similarity{}, {.rays = false, .progress = {}});
        std::vector<Warning> warnings = scene->warnings;
        const auto world = body::BodyWorld::make(*scene, *haptic, &warnings);
        ASSERT_NE(world, nullptr);
        EXPECT_EQ(world->solver().joints().size(), c.joined ? 1u : 0u) << c.ours;
        EXPECT_EQ(body::JointSettings(*world).empty(), *c.message != '\0') << c.ours;
        if (*c.message == '\0') {
            EXPECT_TRUE(warnings.empty());
            continue;
        }
        EXPECT_TRUE(std::ranges::any_of(warnings, [&](const Warning& warning) {
            return warning.message.find(c.message) != std::string::npos;
        })) << c.ours;
    }
}

} // namespace

} // namespace touchstone::test

// The arithmetic of a kept picture.

#include "renderer/frustum.h"
#include "renderer/picture_key.h"
#include "renderer/shadow_area.h"
#include "renderer/step_size.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace touchstone {
namespace {

TEST(StepSize, LearnsHowMuchFitsIntoItsBudget) {
    for (const double unit : {1e-8, 1e-7, 1e-6}) { // s
        StepSize step(0.01);
        for (int i = 0; i < 20; ++i)
            step.done(step.work() * unit, step.work());
        EXPECT_NEAR(step.work() * unit, 0.01, 1e-6) << unit;
    }
}

TEST(StepSize, DoesNotGoByWhatSaysNothing) {
    StepSize step(0.01);
    const double before = step.work();
    step.done(1e-4, 10.0); // the rest of a picture
    step.done(0.0, before);
    step.done(-1.0, before);
    step.done(std::numeric_limits<double>::quiet_NaN(), before);
    EXPECT_EQ(step.work(), before);
    step.done(0.02, 10.0); // little work that took too long
    EXPECT_LT(step.work(), before);
    for (int i = 0; i < 100; ++i)
        step.done(10.0, step.work());
    EXPECT_EQ(step.work(), StepSize::kLeast) << "it goes on";
    for (int i = 0; i < 100; ++i)
        step.done(1e-9, step.work());
    EXPECT_EQ(step.work(), StepSize::kMost);
}

TEST(MovingInstances, TellsWhenOneThatRestedMoves) {
    MovingInstances moving;
    std::vector<glm::dmat4> poses(2, glm::dmat4(1.0));
    EXPECT_TRUE(moving.update(poses)) << "another number of them";
    moving.begin();
    moving.forget();
    poses[0][3].y = 5.0;
    EXPECT_TRUE(moving.update(poses)) << "another scene, elsewhere";
    moving.begin();
    EXPECT_FALSE(moving.moves(0)) << "which rests";
    EXPECT_FALSE(moving.update(poses));
    poses[1][3].x = 1.0;
    EXPECT_TRUE(moving.update(poses));
    moving.begin();
    EXPECT_TRUE(moving.moves(1));
    EXPECT_FALSE(moving.moves(0));
    poses[1][3].x = 2.0;
    EXPECT_FALSE(moving.update(poses)) << "it is known to move";
    EXPECT_FALSE(moving.update(poses)) << "it stops";
    EXPECT_TRUE(moving.moves(1)) << "and is no part of the picture yet";
    moving.begin();
    EXPECT_FALSE(moving.moves(1));
    EXPECT_FALSE(moving.moves(7)) << "no such instance";
    poses[0][0][0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(moving.update(poses));
    moving.begin();
    EXPECT_TRUE(moving.moves(0));
    EXPECT_FALSE(moving.update(poses)) << "a pose that is no number moves forever";
    moving.begin();
    EXPECT_TRUE(moving.moves(0));
}

View someView(bool orthographic) {
    View view;
    view.viewFromWorkspace =
        glm::lookAt(glm::dvec3(0.1, 0.2, 0.5), glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0));
    view.clipFromView = orthographic ? glm::orthoRH_ZO(-0.2, 0.2, -0.15, 0.15, 0.01, 2.0)
                                     : glm::perspectiveRH_ZO(0.7, 4.0 / 3.0, 0.01, 2.0);
    view.lights[0] = {{-0.3, 1.0, 0.8}, glm::vec3(1.0f)};
    return view;
}

TEST(Frustum, MissesNoBallThatIsSeen) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(-1.0, 1.0), size(0.001, 0.3);
    for (const bool orthographic : {false, true}) {
        const View view = someView(orthographic);
        const glm::dmat4 clip = view.clipFromView * view.viewFromWorkspace;
        const Frustum all(clip), part(clip, {-1.0, -0.3}, {1.0, 0.1});
        int missed = 0;
        for (int i = 0; i < 20'000; ++i) {
            const glm::dvec3 centre(place(random), place(random), place(random));
            const double radius = size(random);
            const glm::dvec3 inBall =
                centre + 0.57 * radius * glm::dvec3(place(random), place(random), place(random));
            const glm::dvec4 p = clip * glm::dvec4(inBall, 1.0);
            if (std::abs(p.x) < p.w && std::abs(p.y) < p.w && p.z > 0.0 && p.z < p.w) {
                ASSERT_FALSE(all.misses(centre, radius));
                ASSERT_FALSE(p.y > -0.3 * p.w && p.y < 0.1 * p.w && part.misses(centre, radius));
            }
            missed += all.misses(centre, radius);
        }
        EXPECT_GT(missed, 5000) << "and those that are outside it mostly misses";
        EXPECT_FALSE(all.misses(glm::dvec3(std::numeric_limits<double>::quiet_NaN()), 1.0)) << "no number";
    }
}

/// leftByProbe of shaders/probe_shadow.glsl for the most exposed normal: the share taken of the first light
/// and of the surroundings.
glm::dvec2 mostTaken(const View& view, const glm::dvec3& p) {
    const glm::dvec3 l = glm::normalize(view.lights[0].toLight);
    const glm::dvec3 away = (view.probe.centre - p) / view.probe.radius;
    const double along = glm::dot(away, l), distance2 = glm::dot(away, away);
    const double width = 1.25 + 0.13 * std::max(along, 0.0), cover = 1.0 / (width * width);
    const double inside = std::max(0.0, 1.0 - std::max(distance2 - along * along, 0.0) * cover);
    const double shadow = along > -1.0 ? std::min(1.0, 2.2 * inside) * std::min(1.0, 1.5 * cover) : 0.0;
    return {0.9 * shadow, 1.0 / std::max(distance2, 1.0)};
}

TEST(ShadowArea, HoldsAllThatTheProbeShades) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> place(-0.15, 0.15), unit(0.0, 1.0);
    constexpr glm::ivec2 kSize(400, 300);
    for (const bool orthographic : {false, true})
        for (int i = 0; i < 200; ++i) {
            View view = someView(orthographic);
            view.probe = {{place(random), place(random), place(random)}, 0.0026};
            const PixelArea area = shadowArea(view, kSize);
            const glm::dvec3 down = -glm::normalize(view.lights[0].toLight);
            for (int j = 0; j < 200; ++j) {
                // Along the shadow, and around the probe.
                const glm::dvec3 p = view.probe.centre + down * (0.3 * unit(random) * (j % 2)) +
                                     0.3 * glm::dvec3(place(random), place(random), place(random));
                const glm::dvec2 taken = mostTaken(view, p);
                const glm::dvec4 clip = view.clipFromView * view.viewFromWorkspace * glm::dvec4(p, 1.0);
                if (std::max(taken.x, taken.y) < kUnseen || clip.w <= 0.0 || std::abs(clip.x) >= clip.w ||
                    std::abs(clip.y) >= clip.w)
                    continue;
                const glm::ivec2 pixel(glm::dvec2(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w) *
                                       glm::dvec2(kSize));
                ASSERT_TRUE(pixel.x >= area.low.x && pixel.x < area.high.x && pixel.y >= area.low.y &&
                            pixel.y < area.high.y)
                    << pixel.x << ' ' << pixel.y;
            }
        }
}

TEST(ShadowArea, IsWithinThePictureAndEmptyWithoutAProbe) {
    View view = someView(false);
    EXPECT_TRUE(shadowArea(view, {400, 300}).empty());
    view.probe = {glm::dvec3(0.1, 0.2, 0.5), 0.0026}; // at the eye: everywhere
    const PixelArea all = shadowArea(view, {400, 300});
    EXPECT_EQ(all.low, glm::ivec2(0));
    EXPECT_EQ(all.high, glm::ivec2(400, 300));
    view.probe.centre = glm::dvec3(0.0);
    const PixelArea part = shadowArea(view, {400, 300});
    EXPECT_LT((part.high.x - part.low.x) * (part.high.y - part.low.y), 400 * 300);
    EXPECT_LE(shadowArea(view, {1, 1}).high.x, 1);
}

} // namespace
} // namespace touchstone

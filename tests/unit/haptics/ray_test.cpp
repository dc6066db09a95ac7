// Rays that no float can hold.
#include "haptics/shape/mesh/ray.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <limits>

namespace touchstone::ray_test {
namespace {

TEST(Ray, BeyondWhatEmbreeTakesMeetsNothing) {
    test::TouchBench bench(test::sceneOf(assets::plane(0.1, 0.1)));
    const HapticObject& object = *bench.scene->objects[0];
    const glm::vec3 down(0, -1, 0);
    EXPECT_TRUE(castRay(object, {0.1f, 1.0f, 0.2f}, down, 0.0f, 2.0f));
    EXPECT_TRUE(castRay(object, {0.1f, 1.0f, 0.2f}, down, 0.0f, std::numeric_limits<float>::infinity()));
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                infinity = std::numeric_limits<float>::infinity();
    for (const float far : {1e19f, infinity, nan}) {
        EXPECT_FALSE(castRay(object, {0.1f, far, 0.2f}, down, 0.0f, 2e19f));
        EXPECT_FALSE(castRay(object, {0.1f, 1.0f, 0.2f}, far * down, 0.0f, 2.0f));
    }
    EXPECT_FALSE(castRay(object, {0.1f, 1.0f, 0.2f}, down, nan, 2.0f));
    EXPECT_FALSE(castRay(object, {0.1f, 1.0f, 0.2f}, down, 0.0f, nan));
}

/// A file of a grain beside a plane: Embree's assertion ended the program in the tick. In the grain's own
/// units the hand is 1e20 away.
TEST(Ray, AnObjectOfNoSizeBesideAnotherIsTouchedAround) {
    Scene scene = test::sceneOf(assets::plane(0.1, 0.1));
    glm::dmat4 grain(1e-20);
    grain[3] = {0.02, 0.001, 0.0, 1.0};
    test::addShape(scene, assets::box({0.1, 0.1, 0.1}), grain);
    for (const ContactMethod contact :
         {ContactMethod::Sweep, ContactMethod::Neighbourhood, ContactMethod::Rays})
        for (const Precision precision : {Precision::Double, Precision::Single}) {
            HapticSettings settings;
            settings.contact = contact;
            settings.precision = precision;
            test::TouchBench bench(scene, settings);
            bench.scene->buildNeighbourhoods();
            bench.step({0.0, 0.05, 0.01});
            const HapticOutput& pressed = bench.moveTo({0.01, -0.001, 0.01}, 1.0);
            EXPECT_NEAR(pressed.force.y, 0.6, 1e-3) << static_cast<int>(contact);
            bench.moveTo({0.03, 0.0005, 0.0}, 0.3, [](const HapticOutput& output) {
                EXPECT_FALSE(has(output.flags, TickFlag::ForceFault));
                EXPECT_TRUE(std::isfinite(glm::dot(output.force, output.force)));
            });
        }
}

} // namespace
} // namespace touchstone::ray_test

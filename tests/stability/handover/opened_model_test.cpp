// A model that is opened where the hand is: no force before the hand has left it. Every model after a touch
// at five places of another (ten as a sweep), tick by tick through the servo's own code.

#include "engine/load/scene_loader.h"
#include "haptics/query/surface_distance.h"
#include "haptics/query/surface_pick.h"
#include "tests/stability/handover/stepped_servo.h"
#include "tests/support/recorded_servo.h"
#include "tests/support/shared_files.h"
#include "tests/support/sweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

namespace touchstone::test::opened_model_test {
namespace {

constexpr int kPlaces = 10, kRays = 200;
constexpr double kGoldenAngle = 2.399963229728653;

glm::dvec3 direction(int i, int of) {
    const double y = 1.0 - 2.0 * (i + 0.5) / of, r = std::sqrt(1.0 - y * y);
    return {r * std::cos(kGoldenAngle * i), y, r * std::sin(kGoldenAngle * i)};
}

TouchedScene fitted(const std::filesystem::path& file) {
    TouchedScene scene;
    LoadOptions options;
    options.images.visual = false;
    scene.source = loadScene(file, options);
    scene.haptic = compileHapticScene(*scene.source, workspaceFromScene(*scene.source, Fit::Workspace));
    return scene;
}

/// What is touched at one of ten places, seen from far out. None where nothing lies there.
std::optional<SurfacePick> placeOn(const HapticScene& scene, int place) {
    constexpr double kFar = 0.5; // m
    for (const double aside : {0.0, 0.03, -0.03}) {
        const glm::dvec3 out = direction(place, kPlaces);
        const glm::dvec3 offset = aside * glm::normalize(glm::cross(out, glm::dvec3(0.3, 0.5, 0.8)));
        if (auto hit = pickSurface(scene, {}, kFar * out + offset, -out))
            return hit;
    }
    return std::nullopt;
}

/// By another way than the program's: 200 directions, and the distance from every triangle that is near.
bool hasLeft(const HapticScene& scene, ObjectMotions motions, const glm::dvec3& hip) {
    constexpr double kReach = 4.99e-3; // m
    if (surfaceDistance(scene, motions, hip, kReach) < kReach)
        return false;
    int barred = 0;
    for (int i = 0; i < kRays; ++i)
        barred += pickSurface(scene, motions, hip, direction(i, kRays)) ? 1 : 0;
    return barred < 0.85 * kRays;
}

struct Case {
    bool forceTooEarly = false, felt = false;
};

/// Touches `before`, has `after` opened, waits, and goes straight out.
Case openUnderTheHand(const TouchedScene& before, const TouchedScene& after, const SurfacePick& place,
                      const HapticSettings& settings) {
    constexpr double kSpeed = 0.1, kTick = 1e-3, kOut = 0.3; // m/s, s, m
    PlacedDevice device;
    SteppedServo servo(device);
    servo.loop.setSettings(settings);
    (void)servo.loop.offerScene(before.haptic, before.source);
    Case result;
    glm::dvec3 hip = place.point + 0.012 * place.normal;
    const auto go = [&](const glm::dvec3& to) {
        for (double left = glm::distance(hip, to); left > 0.0; left -= kSpeed * kTick) {
            hip += std::min(1.0, kSpeed * kTick / glm::distance(hip, to)) * (to - hip);
            device.next = at(hip);
            servo.step();
            if (glm::distance(hip, to) < 1e-9)
                break;
        }
    };
    device.next = at(hip);
    for (int i = 0; i < 120; ++i)
        servo.step();
    go(place.point - 0.004 * place.normal);
    result.felt = servo.record.output.contacts > 0;

    (void)servo.loop.offerScene(after.haptic, after.source);
    WorldState world(after.source, *after.haptic);
    bool left = false;
    const glm::dvec3 begin = hip, out = glm::normalize(hip + glm::dvec3(1e-6, 2e-6, 3e-6));
    for (int i = 0; !left && i < 300 + static_cast<int>(kOut / (kSpeed * kTick)); ++i) {
        device.next = at(begin + std::max(0, i - 300) * kSpeed * kTick * out);
        const TickRecord& tick = servo.step();
        // The command that is still held goes to zero as fast as the device may; nothing new is felt.
        if (tick.output.force != glm::dvec3(0.0) || tick.output.contacts > 0 ||
            (i > 2 && tick.output.command.force() != glm::dvec3(0.0)))
            result.forceTooEarly = true;
        const ObjectMotions motions = world.advance(tick.time);
        left = hasLeft(*after.haptic, motions.empty() ? ObjectMotions(after.haptic->restMotions) : motions,
                       tick.output.hip);
    }
    EXPECT_TRUE(left);
    return result;
}

std::vector<std::filesystem::path> ourScenes() {
    return gltfFilesIn(TOUCHSTONE_ASSETS);
}

void expectNoForceBeforeTheHandHasLeft(const std::vector<std::filesystem::path>& opened,
                                       const std::vector<ContactMethod>& methods) {
    const TouchedScene doughnut = fitted(TOUCHSTONE_ASSETS "/doughnut.glb"),
                       swatches = fitted(TOUCHSTONE_ASSETS "/swatches.glb");
    const int step = kPlaces / repetitions(5, kPlaces);
    int cases = 0, touched = 0, tooEarly = 0;
    for (const std::filesystem::path& file : opened) {
        const TouchedScene after = fitted(file);
        if (after.haptic->objects.empty())
            continue;
        for (const ContactMethod method : methods) {
            if (method == ContactMethod::Neighbourhood)
                for (const TouchedScene* scene : {&doughnut, &swatches, &after})
                    scene->haptic->buildNeighbourhoods();
            HapticSettings settings;
            settings.contact = method;
            for (const TouchedScene* before : {&doughnut, &swatches})
                for (int i = 0; i < kPlaces; i += step) {
                    const std::optional<SurfacePick> place = placeOn(*before->haptic, i);
                    if (!place)
                        continue;
                    const Case result = openUnderTheHand(*before, after, *place, settings);
                    ++cases;
                    touched += result.felt ? 1 : 0;
                    tooEarly += result.forceTooEarly ? 1 : 0;
                    EXPECT_FALSE(result.forceTooEarly)
                        << file.filename() << " opened after place " << i << " of " << before->source->path;
                }
        }
    }
    std::printf("%d cases, %d after a touch, force before the hand has left in %d\n", cases, touched,
                tooEarly);
    EXPECT_GT(touched, cases / 2);
    EXPECT_EQ(tooEarly, 0);
}

TEST(OpenedModel, OurScenesGiveNoForceBeforeTheHandHasLeft) {
    expectNoForceBeforeTheHandHasLeft(ourScenes(), {ContactMethod::Sweep});
}

TEST(OpenedModel, NorDoTheyByRaysOrTheWalk) {
    expectNoForceBeforeTheHandHasLeft(
        {TOUCHSTONE_ASSETS "/box.glb", TOUCHSTONE_ASSETS "/moving.glb", TOUCHSTONE_ASSETS "/plane.glb"},
        {ContactMethod::Rays, ContactMethod::Neighbourhood});
}

TEST(OpenedModel, SharedModelsGiveNoForceBeforeTheHandHasLeft) {
    const auto folder = modelsFolder();
    if (!folder)
        GTEST_SKIP() << kNoModels;
    expectNoForceBeforeTheHandHasLeft(gltfFilesIn(*folder), {ContactMethod::Sweep});
}

TEST(OpenedModel, CanBeTouchedOnceTheHandHasLeft) {
    for (const char* file : {"plane.glb", "box.glb", "doughnut.glb"}) {
        const TouchedScene scene = fitted(std::filesystem::path(TOUCHSTONE_ASSETS) / file);
        const std::optional<SurfacePick> place = placeOn(*scene.haptic, 3);
        ASSERT_TRUE(place) << file;
        PlacedDevice device;
        SteppedServo servo(device);
        (void)servo.loop.offerScene(scene.haptic, scene.source);
        const auto rest = [&](double height, int ticks) {
            for (int i = 0; i < ticks; ++i) {
                device.next = at(place->point + height * place->normal);
                servo.step();
            }
        };
        rest(0.002, 300);
        EXPECT_TRUE(has(servo.record.output.flags, TickFlag::StartedInside)) << "within reach";
        rest(0.006, 2);
        EXPECT_FALSE(has(servo.record.output.flags, TickFlag::StartedInside)) << file;
        rest(-0.002, 300);
        EXPECT_GT(glm::length(servo.record.output.command.force()), 0.5) << file;
    }
}

/// A hand that sees the model is where it wants to be.
TEST(OpenedModel, AHandInSightBeginsWhereItIsPutDown) {
    const TouchedScene scene = fitted(TOUCHSTONE_ASSETS "/plane.glb");
    const std::optional<SurfacePick> place = placeOn(*scene.haptic, 3);
    ASSERT_TRUE(place);
    PlacedDevice device;
    SteppedServo servo(device);
    (void)servo.loop.offerScene(scene.haptic, scene.source);
    device.next = at(place->point + 0.002 * place->normal);
    device.next.inSight = device.next.begins = true;
    servo.step();
    device.next.begins = false;
    for (int i = 0; i < 300; ++i) {
        device.next.position = place->point - 0.002 * place->normal;
        servo.step();
    }
    EXPECT_GT(glm::length(servo.record.output.command.force()), 0.5);
    // Where it begins again below the sheet, it is below.
    device.next.begins = true;
    servo.step();
    EXPECT_EQ(servo.record.output.contacts, 0u);
}

} // namespace
} // namespace touchstone::test::opened_model_test

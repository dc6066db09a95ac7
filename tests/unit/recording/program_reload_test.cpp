// Haptic programs that are edited and reloaded while they are felt, and the replay of it.

#include "engine/program/surface_program.h"
#include "haptics/program/felt_program.h"
#include "tests/support/program.h"
#include "tests/support/recorded_servo.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

namespace touchstone::test::program_reload_test {
namespace {

std::shared_ptr<const SurfaceProgram> reloaded(const std::string& body) {
    return compileSurfaceProgram("reloaded.glsl",
                                 "parameter float wave = 500; // 1..5000 1/m\n"
                                 "void touch(const in Touch before, inout Surface after) {\n" +
                                     body + "\n}\n",
                                 {}, [] { return false; });
}

constexpr const char* kNoise =
    "after.position += 1e-4 * filteredNoise(before.position * wave, before.filterWidth * "
    "wave) * before.normal; after.staticFriction = 0.4;";
constexpr const char* kDirection =
    "after.staticFriction = 0.2 + 0.2 * abs(before.toolDirection.x); after.damping += "
    "0.01 * length(before.toolAcceleration) + 0.0001 * before.time;";

TouchedScene withProgram(const TouchedScene& scene, const std::shared_ptr<const SurfaceProgram>& program,
                         double wave) {
    return withChanged(scene, [&](HapticMaterial& material) {
        material.program = materialProgram(program, {{"parameters", {{"wave", wave}}}});
    });
}

/// Strokes over the floor y = 0, 1 mm deep, in from above.
DeviceSample stroking(double time) {
    const double depth = 0.001 - 0.01 * std::exp(-20.0 * time);
    return at({0.02 * std::sin(3.0 * time), -depth, 0.015 * std::sin(2.1 * time)});
}

TEST(ProgramReload, EditsWhileTouchingReplayToTheLastBit) {
    const std::array programs{reloaded(kNoise), reloaded(kDirection)};
    const TouchedScene floor = withProgram(floorScene(0.0f), programs[0], 500.0);
    const ScratchFolder scratch;
    const std::filesystem::path file = scratch / "reload.tsrec";
    RecordedServo rig(stroking);
    rig.recorder.start(file, "test");
    rig.offer(floor);
    rig.ticks(2000);
    const size_t first = rig.records.size();
    for (int i = 0; i < 40; ++i) {
        rig.offer(withProgram(floor, programs[static_cast<size_t>(i % 2)], 400.0 + 20.0 * i),
                  SceneSwap::SameGeometry);
        rig.ticks(150);
    }
    for (size_t i = first; i < rig.records.size(); ++i)
        ASSERT_GT(rig.records[i].output.contacts, 0u) << "touch goes on";
    rig.finish();
    rig.expectWithinLimits();
    EXPECT_EQ(rig.countOf(TickFlag::ProgramFailed), 0u);
    expectEqualReplay(replayOf(file, rig.scenes));
}

/// A thousand reloads: every tick touches, what was replaced is freed, and swaps cost the servo no deadline
/// more than the load of the machine does (printed, since it is not ours to assert).
TEST(ProgramReload, AThousandReloadsKeepTheTouchAndLeaveNothingBehind) {
    const std::array programs{reloaded(kNoise), reloaded(kDirection)};
    const TouchedScene floor = withProgram(floorScene(0.0f), programs[0], 500.0);
    std::vector<std::weak_ptr<const HapticScene>> offered;
    std::vector<std::weak_ptr<const program::FeltProgram>> held;
    {
        RecordedServo rig(stroking);
        rig.offer(floor);
        rig.ticks(2000);
        const auto calm = rig.servo.counters();
        const size_t first = rig.records.size();
        for (int i = 0; i < 1000; ++i) {
            const TouchedScene next =
                withProgram(floor, programs[static_cast<size_t>(i % 2)], 400.0 + 0.5 * i);
            offered.emplace_back(next.haptic);
            held.emplace_back(next.haptic->materials[0].program);
            rig.servo.offerScene(next.haptic, next.source, SceneSwap::SameGeometry);
            rig.ticks(4);
        }
        const auto busy = rig.servo.counters();
        for (size_t i = first; i < rig.records.size(); ++i)
            ASSERT_GT(rig.records[i].output.contacts, 0u) << "touch goes on";
        rig.expectWithinLimits();
        EXPECT_EQ(rig.countOf(TickFlag::ProgramFailed), 0u);
        const auto alive = [](const auto& all) {
            size_t count = 0;
            for (const auto& each : all)
                count += each.expired() ? 0 : 1;
            return count;
        };
        EXPECT_LE(alive(offered), 4u) << "the servo's, the next and those on their way back";
        EXPECT_LE(alive(held), 4u);
        std::printf("missed %llu of %llu ticks before, %llu of %llu during 1000 reloads\n",
                    static_cast<unsigned long long>(calm.missed), static_cast<unsigned long long>(calm.ticks),
                    static_cast<unsigned long long>(busy.missed - calm.missed),
                    static_cast<unsigned long long>(busy.ticks - calm.ticks));
        rig.finish();
    }
    for (const auto& scene : offered)
        EXPECT_TRUE(scene.expired());
}

} // namespace
} // namespace touchstone::test::program_reload_test

// Real time through the library. Times are not asserted: a loaded machine misses deadlines.

#include "tests/support/program.h"
#include "tests/unit/api/floor.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace touchstone::test {
namespace {

/// A device that presses 2 mm into the floor, and what it was commanded.
struct Pressing {
    std::atomic<int> samples{0};
    std::atomic<double> force{0.0}, largest{0.0};

    ts_device device() {
        ts_device device = TS_STRUCT(ts_device);
        device.context = this;
        device.sample = [](void* context, double time, ts_reading* reading) {
            ++static_cast<Pressing*>(context)->samples;
            const double depth =
                std::min(0.002, 0.5 * time - 0.15); // a hand that begins near the model must leave it first
            reading->position[1] = -depth;
            reading->valid = 1;
        };
        device.apply = [](void* context, const double newtons[3]) {
            auto& self = *static_cast<Pressing*>(context);
            self.force = newtons[1];
            self.largest = std::max(self.largest.load(), newtons[1]);
        };
        device.max_force = 1.0;
        return device;
    }
};

/// Pumps until `done` holds; false after a minute.
template <class Done>
bool pumpUntil(ts::Session& session, const Done& done) {
    for (int i = 0; i < 6000; ++i) {
        if (done(session.pump()))
            return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

TEST(LiveSession, GivesTheForceToAnOwnDeviceWithinItsLimits) {
    Pressing pressing;
    {
        ts::Session session(pressing.device());
        session.touch(ts::Scene({floorMesh()})); // closed at once: the session goes on touching it
        session.start();
        EXPECT_TRUE(
            pumpUntil(session, [](const ts_state& s) { return s.touching != 0 && s.force[1] > 1.1; }));
        EXPECT_TRUE(pumpUntil(session, [&](const ts_state&) { return pressing.force > 0.99; }));
        session.force(false);
        EXPECT_TRUE(pumpUntil(session, [&](const ts_state&) { return pressing.force == 0.0; }));
        session.force(true);
        session.set("stiffness", "100"); // 0.2 N
        EXPECT_TRUE(pumpUntil(
            session, [&](const ts_state&) { return pressing.force > 0.19 && pressing.force < 0.21; }));
        session.stop();
        EXPECT_EQ(pressing.force, 0.0) << "the last command is zero";
    }
    EXPECT_LE(pressing.largest, 1.0 + 1e-12);
    EXPECT_GT(pressing.samples, 100);
}

ts_goal floorGoal(double height) {
    ts_goal goal = TS_STRUCT(ts_goal);
    goal.touching = 1;
    goal.proxy[1] = height;
    goal.stiffness = 200.0;
    goal.planes[0][1] = 1.0;
    goal.plane_count = 1;
    return goal;
}

// 250 Hz of contact, 4 kHz of control; then the caller renders it.
TEST(LiveSession, HoldsAnOwnDeviceByAControlLoopApart) {
    Pressing pressing;
    const ts_device device = pressing.device();
    ts_session_options options = TS_STRUCT(ts_session_options);
    options.own = &device;
    options.rate = 250.0;
    options.control = 4000.0;
    options.goal_power = 10.0;
    ts::Handle<ts_session, ts_session_close> handle;
    ts::check(ts_session_create(&options, handle.out()));
    ts_session session = handle.get();
    EXPECT_EQ(ts_session_render(session, 1), TS_STATE);
    ts::check(ts_session_touch(session, ts::Scene({floorMesh()}).get()));
    ts::check(ts_session_start(session));
    const auto until = [&](const auto& done) {
        ts_state state = TS_STRUCT(ts_state);
        for (int i = 0; i < 6000; ++i) {
            ts::check(ts_session_pump(session, &state));
            if (done(state))
                return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    };
    EXPECT_TRUE(until([&](const ts_state& s) { return pressing.force > 0.99 && s.rendered == 0; }));
    EXPECT_TRUE(until([](const ts_state& s) { return s.control_ticks > s.ticks; }));

    ts::check(ts_session_render(session, 1));
    EXPECT_TRUE(until([&](const ts_state& s) { return s.rendered == 1 && pressing.force == 0.0; }));
    const ts_goal goal = floorGoal(0.0); // 200 N/m, 2 mm deep
    EXPECT_TRUE(until([&](const ts_state& s) {
        ts::check(ts_session_goal(session, &goal));
        return std::abs(pressing.force - 0.4) < 1e-9 && std::abs(s.command[1] - 0.4) < 1e-9;
    }));
    EXPECT_TRUE(until([&](const ts_state&) { return pressing.force == 0.0; })) << "after a silence";
    const ts_goal far = floorGoal(900.0);
    EXPECT_TRUE(until([&](const ts_state&) {
        ts::check(ts_session_goal(session, &far));
        return pressing.force > 0.99;
    }));
    ts::check(ts_session_force(session, 0));
    EXPECT_TRUE(until([&](const ts_state&) {
        ts::check(ts_session_goal(session, &far));
        return pressing.force == 0.0;
    }));
    ts::check(ts_session_stop(session));
    EXPECT_LE(pressing.largest, 1.0 + 1e-12);
}

TEST(LiveSession, ChangesAMaterialWhileItIsTouched) {
    Pressing pressing;
    const ts_device device = pressing.device();
    ts_session_options options = TS_STRUCT(ts_session_options);
    options.own = &device;
    ts::Handle<ts_session, ts_session_close> handle;
    ts::check(ts_session_create(&options, handle.out()));
    ts_session session = handle.get();
    EXPECT_EQ(ts_session_material(session, 0, "stiffness", 100.0), TS_STATE);
    const ts::Scene scene({floorMesh()});
    ts::check(ts_session_touch(session, scene.get()));
    ts::check(ts_session_start(session));
    const auto reaches = [&](double newtons) {
        ts_state state = TS_STRUCT(ts_state);
        for (int i = 0; i < 6000; ++i) {
            ts::check(ts_session_pump(session, &state));
            if (std::abs(pressing.force - newtons) < 1e-3)
                return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    };
    EXPECT_TRUE(reaches(1.0)); // 600 N/m, 2 mm deep, at most 1 N
    ts::check(ts_session_material(session, 0, "stiffness", 100.0));
    EXPECT_TRUE(reaches(0.2));
    ts::check(ts_session_material(session, 0, "stiffness", 300.0));
    EXPECT_TRUE(reaches(0.6));
    EXPECT_EQ(ts_session_material(session, 1, "stiffness", 1.0), TS_ARGUMENT);
    EXPECT_EQ(ts_session_material(session, ~uint64_t{0}, "stiffness", 1.0), TS_ARGUMENT);
    EXPECT_EQ(ts_session_material(session, 0, "voxelSize", 1.0), TS_ARGUMENT);
    EXPECT_EQ(ts_session_material(session, 0, nullptr, 1.0), TS_ARGUMENT);
    EXPECT_EQ(ts_session_material(session, 0, "stiffness", -1.0), TS_ARGUMENT);
    EXPECT_EQ(ts_session_material(session, 0, "stiffness", INFINITY), TS_ARGUMENT);
    EXPECT_TRUE(reaches(0.6)) << "a refused call changes nothing";
    ts::check(ts_session_material(session, 0, "stiffness", NAN));
    EXPECT_TRUE(reaches(1.0));

    double value = 0.0;
    ts::check(ts_scene_material_number(scene.get(), 0, "stiffness", &value));
    EXPECT_TRUE(std::isnan(value));
    EXPECT_EQ(ts_scene_material_number(scene.get(), 9, "stiffness", &value), TS_ARGUMENT);
    EXPECT_EQ(ts_scene_material_number(scene.get(), 0, "stiffness", nullptr), TS_ARGUMENT);
    ts_number_info info = TS_STRUCT(ts_number_info);
    EXPECT_GT(ts_material_number_count(), 4u);
    ts::check(ts_material_number_get_info(0, &info));
    EXPECT_LT(info.least, info.most);
    EXPECT_EQ(ts_material_number_get_info(ts_material_number_count(), &info), TS_ARGUMENT);
    size_t needed = 0;
    ts::check(ts_scene_material_name(scene.get(), 0, nullptr, 0, &needed));
    EXPECT_GT(needed, 1u);
}

TEST(LiveSession, RefusesGoalsThatAreNone) {
    ts_session_options options = TS_STRUCT(ts_session_options);
    options.device = "stroke";
    for (const double wrong : {-1.0, 99.0, 4001.0, std::nan(""), double{INFINITY}}) {
        options.control = wrong;
        ts_session none = nullptr;
        EXPECT_EQ(ts_session_create(&options, &none), TS_ARGUMENT) << wrong;
    }
    options.control = 1000.0;
    options.goal_power = std::nan("");
    ts_session none = nullptr;
    EXPECT_EQ(ts_session_create(&options, &none), TS_ARGUMENT);
    options.goal_power = 0.0;
    ts::Handle<ts_session, ts_session_close> handle;
    ts::check(ts_session_create(&options, handle.out()));
    ts_goal goal = floorGoal(0.0);
    EXPECT_EQ(ts_session_goal(handle.get(), &goal), TS_STATE);
    ts::check(ts_session_touch(handle.get(), ts::Scene({floorMesh()}).get()));
    EXPECT_EQ(ts_session_goal(handle.get(), &goal), TS_OK);
    EXPECT_EQ(ts_session_goal(handle.get(), nullptr), TS_ARGUMENT);
    const auto refuse = [&](auto&& change) {
        ts_goal wrong = floorGoal(0.0);
        change(wrong);
        EXPECT_EQ(ts_session_goal(handle.get(), &wrong), TS_ARGUMENT) << ts_last_error();
    };
    refuse([](ts_goal& g) { g.proxy[2] = std::nan(""); });
    refuse([](ts_goal& g) { g.proxy[0] = 1e300; });
    refuse([](ts_goal& g) { g.stiffness = -5.0; });
    refuse([](ts_goal& g) { g.stiffness = INFINITY; });
    refuse([](ts_goal& g) { g.damping = -1.0; });
    refuse([](ts_goal& g) { g.plane_count = 4; });
    refuse([](ts_goal& g) { g.plane_count = size_t{1} << 33; });
    refuse([](ts_goal& g) { g.planes[0][1] = 1.1; });
    refuse([](ts_goal& g) { g.planes[0][1] = std::nan(""); });
}

TEST(LiveSession, CallsBackAndRecordsAStroke) {
    const ScratchFolder folder;
    const std::string file = (folder / "stroke.tsrec").string();
    ts_session session = nullptr;
    ts_session_options options = TS_STRUCT(ts_session_options);
    options.device = "stroke:circle";
    options.keep = 100'000;
    ts::check(ts_session_create(&options, &session));
    const ts::Scene scene(TOUCHSTONE_ASSETS "/doughnut.glb", TS_FIT_WORKSPACE);
    ts::check(ts_session_touch(session, scene.get()));
    ts::check(ts_session_record(session, file.c_str()));
    struct Seen {
        int calls = 0, contacts = 0;
    } seen;
    ts::check(ts_session_run(
        session, 3.0, 60.0,
        [](void* context, const ts_state* state) {
            ++static_cast<Seen*>(context)->calls;
            static_cast<Seen*>(context)->contacts += state->contacts > 0;
            return 0;
        },
        &seen));
    ts::check(ts_session_record(session, nullptr));
    EXPECT_GT(seen.calls, 10);
    EXPECT_GT(seen.contacts, 3);
    ts::Ticks kept(100'000);
    ts_ticks arrays = kept.arrays();
    size_t count = 0;
    ts::check(ts_session_take(session, &arrays, &count));
    EXPECT_GT(count, 500u);
    ts::check(ts_session_close(session));

    // The recording has the same ticks, and the program replays them to the last bit.
    ts_recording recording = nullptr;
    ts::check(ts_recording_open(file.c_str(), &recording));
    ts::Ticks read(100'000);
    arrays = read.arrays();
    arrays.normal = nullptr;
    arrays.penetration = nullptr;
    size_t recorded = 0;
    ts::check(ts_recording_read(recording, &arrays, &recorded));
    ASSERT_EQ(recorded, count);
    for (size_t i = 0; i < count; ++i) {
        ASSERT_EQ(read.time[i], kept.time[i]);
        ASSERT_EQ(read.force[i], kept.force[i]);
        ASSERT_EQ(read.hip[i], kept.hip[i]);
    }
    size_t none = 1;
    ts::check(ts_recording_read(recording, &arrays, &none));
    EXPECT_EQ(none, 0u);
    EXPECT_EQ(ts::text([&](char* out, size_t room, size_t* needed) {
                  return ts_recording_text(recording, "command", out, room, needed);
              }),
              "api");
    ts::check(ts_recording_close(recording));
}

TEST(LiveSession, EndsWhereTheCallbackSaysSoOrThrows) {
    Pressing pressing;
    ts::Session session(pressing.device());
    session.touch(ts::Scene({floorMesh()}));
    int calls = 0;
    session.run(600.0, [&](const ts_state&) { return ++calls < 3; });
    EXPECT_EQ(calls, 3);
    EXPECT_THROW(session.run(600.0, [](const ts_state&) -> bool { throw std::runtime_error("no"); }),
                 std::runtime_error);
}

/// Closed by another thread while it runs, and set by a third.
TEST(LiveSession, MayBeUsedAndClosedByOtherThreads) {
    Pressing pressing;
    const ts_device device = pressing.device();
    ts_session_options options = TS_STRUCT(ts_session_options);
    options.own = &device;
    ts_session session = nullptr;
    ts::check(ts_session_create(&options, &session));
    ts::check(ts_session_touch(session, ts::Scene({floorMesh()}).get()));
    std::atomic<int> calls{0};
    std::atomic<ts_status> ended{TS_OK};
    std::thread runner([&] {
        ended = ts_session_run(
            session, 600.0, 100.0,
            [](void* c, const ts_state*) { return (++*static_cast<std::atomic<int>*>(c), 0); }, &calls);
    });
    std::thread setter([&] {
        for (int i = 0; ts_session_set(session, "stiffness", i % 2 != 0 ? "300" : "400") == TS_OK; ++i)
            std::this_thread::sleep_for(std::chrono::microseconds(100));
    });
    while (calls < 20)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(ts_session_close(session), TS_OK);
    runner.join();
    setter.join();
    EXPECT_EQ(ended, TS_CLOSED);
    EXPECT_EQ(ts_session_close(session), TS_CLOSED);
    EXPECT_EQ(pressing.force, 0.0);
}

} // namespace
} // namespace touchstone::test

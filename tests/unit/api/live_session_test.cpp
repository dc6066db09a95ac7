// Real time through the library. Times are not asserted: a loaded machine misses deadlines.

#include "tests/support/program.h"
#include "tests/unit/api/floor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

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

/// False where it does not come to hold in a minute.
template <class Holds>
bool withinAMinute(const Holds& holds) {
    for (int i = 0; i < 6000; ++i) {
        if (holds())
            return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

/// A session with that device, by the C interface.
struct PressedSession {
    Pressing pressing;
    const ts_device device = pressing.device();
    ts::Handle<ts_session, ts_session_close> handle;
    ts_state state = TS_STRUCT(ts_state); ///< of the last pump

    explicit PressedSession(ts_session_options options = TS_STRUCT(ts_session_options)) {
        options.own = &device;
        ts::check(ts_session_create(&options, handle.out()));
    }
    /// Pumps until `done` holds; false after a minute.
    template <class Done>
    bool until(const Done& done) {
        return withinAMinute([&] {
            ts::check(ts_session_pump(handle.get(), &state));
            return done();
        });
    }
};

/// Pumps until `done` holds; false after a minute.
template <class Done>
bool pumpUntil(ts::Session& session, const Done& done) {
    return withinAMinute([&] { return done(session.pump()); });
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

/// Two devices and a simulated hand at one servo, each within its own limits.
TEST(LiveSession, DrivesSeveralHands) {
    Pressing first, second;
    {
        const ts_device devices[2]{first.device(), [&] {
                                       ts_device device = second.device();
                                       device.max_force = 0.5;
                                       return device;
                                   }()};
        ts_other_hand others[2]{TS_STRUCT(ts_other_hand), TS_STRUCT(ts_other_hand)};
        others[0].own = &devices[1];
        others[1].device = "stroke";
        ts_session_options options = TS_STRUCT(ts_session_options);
        options.own = &devices[0];
        options.others = others;
        options.other_count = 2;
        options.keep = 100'000;
        ts::Session session(options);
        session.touch(ts::Scene({floorMesh()}));
        session.start();
        EXPECT_TRUE(pumpUntil(session, [&](const ts_state& s) {
            return s.touching != 0 && first.force > 0.99 && second.force > 0.49 &&
                   session.hand(1).force[1] > 1.1;
        }));
        EXPECT_TRUE(pumpUntil(session, [&](const ts_state&) { return session.hand(2).contacts > 0; }));
        EXPECT_EQ(session.hand(0).tick, session.hand(1).tick);
        session.stop();
        EXPECT_EQ(first.force, 0.0);
        EXPECT_EQ(second.force, 0.0);
        std::vector<double> times[3];
        for (size_t hand = 0; hand < 3; ++hand) {
            ts_ticks ticks = TS_STRUCT(ts_ticks);
            times[hand].resize(100'000);
            ticks.time = times[hand].data();
            ticks.capacity = times[hand].size();
            size_t count = 0;
            ts::check(ts_session_take_hand(session.get(), hand, &ticks, &count));
            times[hand].resize(count);
        }
        EXPECT_GT(times[0].size(), 100u);
        EXPECT_EQ(times[0], times[1]);
        EXPECT_EQ(times[0], times[2]);
    }
    EXPECT_LE(first.largest, 1.0 + 1e-12);
    EXPECT_LE(second.largest, 0.5 + 1e-12);
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
    ts_session_options options = TS_STRUCT(ts_session_options);
    options.rate = 250.0;
    options.control = 4000.0;
    options.goal_power = 10.0;
    PressedSession pressed(options);
    const Pressing& pressing = pressed.pressing;
    ts_session session = pressed.handle.get();
    EXPECT_EQ(ts_session_render(session, 1), TS_STATE);
    ts::check(ts_session_touch(session, ts::Scene({floorMesh()}).get()));
    ts::check(ts_session_start(session));
    const auto until = [&](const auto& done) { return pressed.until([&] { return done(pressed.state); }); };
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
    PressedSession pressed;
    const Pressing& pressing = pressed.pressing;
    ts_session session = pressed.handle.get();
    EXPECT_EQ(ts_session_material(session, 0, "stiffness", 100.0), TS_STATE);
    const ts::Scene scene({floorMesh()});
    ts::check(ts_session_touch(session, scene.get()));
    ts::check(ts_session_start(session));
    const auto reaches = [&](double newtons) {
        return pressed.until([&] { return std::abs(pressing.force - newtons) < 1e-3; });
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

// The goal may come before the loop has heard that it is to follow goals.
TEST(LiveSession, TheFirstGoalAfterRenderIsFollowed) {
    ts_session_options options = TS_STRUCT(ts_session_options);
    options.control = 100.0; // 10 ms for the two calls
    options.goal_power = 10.0;
    PressedSession pressed(options);
    ts_session session = pressed.handle.get();
    ts::check(ts_session_touch(session, ts::Scene({floorMesh()}).get()));
    ts::check(ts_session_start(session));
    ts_state& state = pressed.state;
    (void)pressed.until([&] { return state.control_ticks >= 100; });
    const ts_goal far = floorGoal(900.0);
    int followedTurns = 0;
    for (int turn = 0; turn < 30 && followedTurns < 3; ++turn) {
        const auto begin = std::chrono::steady_clock::now();
        ts::check(ts_session_render(session, 1));
        ts::check(ts_session_goal(session, &far));
        bool followed = false;
        for (int i = 0; i < 100 && !followed; ++i) { // 0.25 s of silence let it go
            ts::check(ts_session_pump(session, &state));
            followed = state.rendered == 1 && state.contacts == 1;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
        EXPECT_TRUE(followed || took.count() > 0.2) << turn; // a stall of this thread is such a silence
        followedTurns += followed ? 1 : 0;
        ts::check(ts_session_render(session, 0));
        (void)pressed.until([&] { return state.rendered == 0; });
    }
    EXPECT_EQ(followedTurns, 3);
}

/// Three squares side by side as a .gltf: the first one has material 0, the others, the middle one of which
/// the hand touches, have none.
std::filesystem::path threeSquares(const ScratchFolder& folder) {
    std::vector<float> corners;
    for (const float x : {-0.075f, -0.025f, 0.025f})
        for (const auto& [dx, z] : {std::pair{0.0f, -0.05f}, {0.0f, 0.05f}, {0.05f, 0.05f}, {0.05f, -0.05f}})
            corners.insert(corners.end(), {x + dx, 0.0f, z});
    const std::vector<uint16_t> indices{0, 1, 2, 0, 2, 3};
    std::ofstream data(folder / "squares.bin", std::ios::binary);
    data.write(reinterpret_cast<const char*>(corners.data()),
               static_cast<std::streamsize>(4 * corners.size()));
    data.write(reinterpret_cast<const char*>(indices.data()),
               static_cast<std::streamsize>(2 * indices.size()));
    data.close();
    std::ofstream text(folder / "squares.gltf");
    text << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"materials":[{"name":"one"}],"buffers":[{"uri":"squares.bin","byteLength":156}],
"bufferViews":[{"buffer":0,"byteLength":144},{"buffer":0,"byteOffset":144,"byteLength":12}],
"meshes":[{"primitives":[)";
    for (int i = 0; i < 3; ++i)
        text << (i > 0 ? "," : "") << R"({"attributes":{"POSITION":)" << i << R"(},"indices":3)"
             << (i == 0 ? R"(,"material":0})" : "}");
    text << R"(]}],"accessors":[)";
    for (int i = 0; i < 3; ++i)
        text << R"({"bufferView":0,"byteOffset":)" << 48 * i
             << R"(,"componentType":5126,"count":4,"type":"VEC3","min":[)" << corners[12 * i]
             << ",0,-0.05],\"max\":[" << corners[12 * i] + 0.05f << ",0,0.05]},";
    text << R"({"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}]})";
    return folder / "squares.gltf";
}

TEST(LiveSession, ARecordingHasChangesOfSurfacesThatTheFileHasNoMaterialFor) {
    const ScratchFolder folder;
    const std::string model = threeSquares(folder).string(), file = (folder / "changed.tsrec").string();
    PressedSession pressed;
    ts_session session = pressed.handle.get();
    const ts::Scene scene(model, TS_FIT_NONE);
    ASSERT_EQ(scene.info().materials, 2u);
    ts::check(ts_session_touch(session, scene.get()));
    ts::check(ts_session_start(session));
    const ts_state& state = pressed.state;
    const auto touches = [&](double newtons) {
        return pressed.until([&] { return state.contacts > 0 && std::abs(state.force[1] - newtons) < 1e-3; });
    };
    EXPECT_TRUE(touches(1.2));
    ts::check(ts_session_material(session, 0, "stiffness", 400.0)); // before the recording
    ts::check(ts_session_material(session, 1, "stiffness", 100.0));
    ts::check(ts_session_record(session, file.c_str()));
    EXPECT_TRUE(touches(0.2));
    ts::check(ts_session_material(session, 1, "stiffness", 300.0)); // and in it
    EXPECT_TRUE(touches(0.6));
    ts::check(ts_session_record(session, nullptr));
    ts::check(ts_session_stop(session));
    const ProgramResult replay = runProgram({TOUCHSTONE_BINARY, "replay", file});
    EXPECT_EQ(replay.status, 0) << replay.out << replay.err;
}

TEST(LiveSession, MovesAnObjectUnderTheHandAndRecordsIt) {
    const ScratchFolder folder;
    const std::string model = threeSquares(folder).string(), file = (folder / "moved.tsrec").string();
    ts_session_options options = TS_STRUCT(ts_session_options);
    options.keep = 1'000'000;
    PressedSession pressed(options);
    const Pressing& pressing = pressed.pressing;
    ts_session session = pressed.handle.get();
    ts_pose pose = TS_STRUCT(ts_pose);
    EXPECT_EQ(ts_session_move(session, 0, &pose), TS_STATE);
    EXPECT_EQ(ts_session_halt(session), TS_STATE);
    const ts::Scene scene(model, TS_FIT_NONE);
    const uint64_t objects = scene.info().objects;
    ts::check(ts_session_touch(session, scene.get()));
    ts::check(ts_session_record(session, file.c_str()));
    ts::check(ts_session_start(session));
    ts_state& state = pressed.state;
    const auto until = [&](const auto& done) { return pressed.until(done); };
    EXPECT_TRUE(until([&] { return state.contacts > 0 && state.force[1] > 1.1; }));
    const auto object = static_cast<uint64_t>(state.object); // the hand's
    ts_object_info info = TS_STRUCT(ts_object_info);
    ts::check(ts_scene_object(scene.get(), object, &info));
    EXPECT_EQ(info.movable, 1);
    EXPECT_EQ(ts_scene_object(scene.get(), objects, &info), TS_ARGUMENT);
    EXPECT_EQ(ts_session_move(session, objects, &pose), TS_ARGUMENT);
    EXPECT_EQ(ts_session_move(session, object, nullptr), TS_ARGUMENT);
    for (const auto& wrong : {std::pair{&ts_pose::speed, 0.6},
                              {&ts_pose::speed, -0.1},
                              {&ts_pose::turn, 7.0},
                              {&ts_pose::turn, std::nan("")}}) {
        ts_pose bad = pose;
        bad.*wrong.first = wrong.second;
        EXPECT_EQ(ts_session_move(session, object, &bad), TS_ARGUMENT);
    }
    for (const double wrong : {1.5, double{INFINITY}, std::nan("")}) {
        ts_pose bad = pose;
        bad.position[1] = wrong;
        EXPECT_EQ(ts_session_move(session, object, &bad), TS_ARGUMENT) << wrong;
        bad = pose;
        bad.orientation[2] = wrong;
        EXPECT_EQ(ts_session_move(session, object, &bad), TS_ARGUMENT) << wrong;
    }
    // Up by 1 mm: the hand stays where it is and is pressed 3 mm deep, the device's limit aside; down by 5 mm
    // it is free.
    std::copy(info.centre, info.centre + 3, pose.position);
    pose.position[1] += 0.001;
    pose.speed = 0.01;
    ts::check(ts_session_move(session, object, &pose));
    EXPECT_TRUE(until([&] { return state.force[1] > 1.75; }));
    EXPECT_NEAR(state.proxy[1], info.centre[1] + 0.001, 1e-4);
    pose.position[1] -= 0.006;
    ts::check(ts_session_move(session, object, &pose));
    EXPECT_TRUE(until([&] { return state.contacts == 0 && state.force[1] == 0.0; }));
    ts_pose now = TS_STRUCT(ts_pose);
    EXPECT_TRUE(until([&] {
        ts::check(ts_session_pose(session, object, &now));
        return now.position[1] == pose.position[1];
    }));
    EXPECT_EQ(now.orientation[0], 1.0);
    // Halted on its way it stays there.
    pose.position[1] = 0.2;
    ts::check(ts_session_move(session, object, &pose));
    EXPECT_TRUE(until([&] {
        ts::check(ts_session_pose(session, object, &now));
        return now.position[1] > info.centre[1] - 0.0045;
    }));
    ts::check(ts_session_halt(session));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    ts::check(ts_session_pump(session, &state));
    ts::check(ts_session_pose(session, object, &now));
    ts_pose later = TS_STRUCT(ts_pose);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    ts::check(ts_session_pose(session, object, &later));
    EXPECT_EQ(later.position[1], now.position[1]);
    EXPECT_LT(now.position[1], 0.1);
    ts::check(
        ts_session_material(session, 0, "stiffness", 400.0)); // its motion outlives a change of materials
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    ts::check(ts_session_pump(session, &state));
    ts::check(ts_session_pose(session, object, &later));
    EXPECT_EQ(later.position[1], now.position[1]);
    ts::check(ts_session_record(session, nullptr));
    ts::check(ts_session_stop(session));
    EXPECT_LE(pressing.largest, 1.0 + 1e-12);
    const ProgramResult replay = runProgram({TOUCHSTONE_BINARY, "replay", file});
    EXPECT_EQ(replay.status, 0) << replay.out << replay.err;
}

/// More ticks take goals than there is room for their states, and nobody pumps: none is lost.
TEST(LiveSession, RecordsEveryGoalWithoutAPump) {
    const ScratchFolder folder;
    const std::string file = (folder / "goals.tsrec").string();
    Pressing pressing;
    ts::Session session(pressing.device(), 4000.0);
    session.touch(ts::Scene(threeSquares(folder).string()));
    session.record(file);
    session.start();
    ts_pose pose = TS_STRUCT(ts_pose);
    pose.speed = 0.001;
    const ts_state begin = session.pump();
    for (int goal = 0; goal < 6000; ++goal) {
        pose.position[1] = 1e-6 * goal;
        session.move(0, pose);
        std::this_thread::sleep_for(std::chrono::microseconds(300));
    }
    session.halt();
    EXPECT_GT(session.pump().ticks, begin.ticks + 3000);
    session.endRecording();
    session.stop();
    const ProgramResult replay = runProgram({TOUCHSTONE_BINARY, "replay", file});
    EXPECT_EQ(replay.status, 0) << replay.out << replay.err;
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

// Real time through the library. Times are not asserted: a loaded machine misses deadlines.

#include "tests/support/program.h"
#include "tests/unit/api/pressing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace touchstone::test {
namespace {

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
    EXPECT_EQ(ts_recording_hands(recording, &none), TS_OK);
    EXPECT_EQ(none, 1u);
    EXPECT_EQ(ts_recording_read_hand(recording, 1, &arrays, &none), TS_ARGUMENT);
    ts::check(ts_recording_close(recording));
}

/// The ticks of each hand, in pieces that are no multiple of the chunks, whichever is read first.
TEST(LiveSession, RecordsEveryHand) {
    const ScratchFolder folder;
    const std::string file = (folder / "hands.tsrec").string();
    ts_other_hand others[2]{TS_STRUCT(ts_other_hand), TS_STRUCT(ts_other_hand)};
    others[0].device = "stroke:spiral";
    others[1].device = "stroke:circle";
    ts_session_options options = TS_STRUCT(ts_session_options);
    options.device = "stroke:circle";
    options.others = others;
    options.other_count = 2;
    options.keep = 100'000;
    ts::Session session(options);
    session.touch(ts::Scene(TOUCHSTONE_ASSETS "/doughnut.glb", TS_FIT_WORKSPACE));
    session.record(file);
    session.start();
    EXPECT_TRUE(pumpUntil(session, [&](const ts_state& first) {
        return first.contacts > 0 && session.hand(1).contacts > 0 && session.hand(2).contacts > 0;
    }));
    session.stop();
    session.endRecording();
    ts::Handle<ts_recording, ts_recording_close> recording;
    ts::check(ts_recording_open(file.c_str(), recording.out()));
    for (const size_t hand : {2, 0, 1}) {
        ts::Ticks kept(100'000), read(777);
        ts_ticks arrays = kept.arrays();
        size_t ticks = 0, done = 0, contacts = 0, count = 0;
        ts::check(ts_session_take_hand(session.get(), hand, &arrays, &ticks));
        arrays = read.arrays();
        arrays.normal = nullptr;
        arrays.penetration = nullptr;
        do {
            ts::check(ts_recording_read_hand(recording.get(), hand, &arrays, &count));
            ASSERT_LE(done + count, ticks);
            for (size_t i = 0; i < count; ++i, ++done) {
                ASSERT_EQ(read.time[i], kept.time[done]);
                ASSERT_EQ(read.hip[i], kept.hip[done]);
                ASSERT_EQ(read.force[i], kept.force[done]);
                ASSERT_EQ(read.command[i], kept.command[done]);
                contacts += read.contacts[i] > 0 ? 1 : 0;
            }
        } while (count > 0);
        EXPECT_GT(contacts, 0u) << hand;
        EXPECT_EQ(done, ticks) << hand;
    }
    size_t hands = 0;
    ts::check(ts_recording_hands(recording.get(), &hands));
    EXPECT_EQ(hands, 3u);
    EXPECT_EQ(ts_recording_read_hand(recording.get(), 3, nullptr, &hands), TS_ARGUMENT);
    EXPECT_EQ(ts_recording_hands(recording.get(), nullptr), TS_ARGUMENT);
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

// Wrong calls get an error that names the argument, and nothing else happens.

#include "tests/support/program.h"
#include "tests/unit/api/floor.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstddef>
#include <limits>
#include <thread>

namespace touchstone::test {
namespace {

void expectRefused(ts_status status, ts_status wanted, const std::string& part) {
    EXPECT_EQ(status, wanted) << ts_status_name(status) << ": " << ts_last_error();
    EXPECT_NE(std::string(ts_last_error()).find(part), std::string::npos) << ts_last_error();
}

ts_scene floorScene() {
    static const ts::Scene kFloor({floorMesh()});
    return kFloor.get();
}

ts_path pathOver(const std::vector<ts::Vector>& rows) {
    ts_path path = TS_STRUCT(ts_path);
    path.positions = rows.data()->data();
    path.count = rows.size();
    return path;
}

TEST(BadCalls, OfAPath) {
    std::vector<ts::Vector> rows = press(50);
    ts_path path = pathOver(rows);
    rows[17][2] = NAN;
    expectRefused(ts_touch(floorScene(), nullptr, &path, nullptr), TS_ARGUMENT, "path.positions[17]");
    rows[17][2] = -std::numeric_limits<double>::infinity();
    expectRefused(ts_touch(floorScene(), nullptr, &path, nullptr), TS_ARGUMENT, "path.positions[17]");
    rows[17][2] = 1e300;
    EXPECT_EQ(ts_touch(floorScene(), nullptr, &path, nullptr), TS_OK) << "far away, but a place";
    rows[17][2] = 0.0;
    std::vector<double> times(rows.size());
    for (size_t i = 0; i < times.size(); ++i)
        times[i] = static_cast<double>(i) * 1e-3;
    path.times = times.data();
    times[30] = times[29];
    expectRefused(ts_touch(floorScene(), nullptr, &path, nullptr), TS_ARGUMENT, "path.times[30]");
    times[30] = NAN;
    expectRefused(ts_touch(floorScene(), nullptr, &path, nullptr), TS_ARGUMENT, "path.times[30]");
    path.times = nullptr;
    path.rate = -5.0;
    expectRefused(ts_touch(floorScene(), nullptr, &path, nullptr), TS_ARGUMENT, "path.rate");
    path.rate = 0.0;
    path.positions = nullptr;
    expectRefused(ts_touch(floorScene(), nullptr, &path, nullptr), TS_ARGUMENT, "path.positions");
    path.count = 0;
    EXPECT_EQ(ts_touch(floorScene(), nullptr, &path, nullptr), TS_OK) << "no ticks";
    expectRefused(ts_touch(floorScene(), nullptr, nullptr, nullptr), TS_ARGUMENT, "path");
    path.size = 0;
    expectRefused(ts_touch(floorScene(), nullptr, &path, nullptr), TS_ARGUMENT, "TS_STRUCT");
}

TEST(BadCalls, OfTicks) {
    const std::vector<ts::Vector> rows = press(50);
    const ts_path path = pathOver(rows);
    ts::Ticks room(49);
    const ts_ticks arrays = room.arrays();
    expectRefused(ts_touch(floorScene(), nullptr, &path, &arrays), TS_ARGUMENT, "ticks.capacity");
    struct {
        ts_ticks known;
        double unknown;
    } later{TS_STRUCT(ts_ticks), 0.0};
    later.known.size = sizeof later;
    EXPECT_EQ(ts_touch(floorScene(), nullptr, &path, &later.known), TS_OK) << "of a later version, unused";
    later.unknown = 1.0;
    expectRefused(ts_touch(floorScene(), nullptr, &path, &later.known), TS_ARGUMENT, "does not know");
}

/// A thousand million rows, whose memory the system makes as it is read; stopped after the first block.
TEST(BadCalls, OfATooLongPath) {
    // A file of zeros over and over again: some kernels give each page that is only read memory of its own.
    constexpr size_t kRows = 1'000'000'000, kPiece = size_t{1} << 26;
    constexpr size_t kBytes = (kRows * 24 + kPiece - 1) / kPiece * kPiece;
    void* const memory = mmap(nullptr, kBytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED)
        GTEST_SKIP() << "the system gives no address space of 24 GB";
    const int zeros = memfd_create("zeros", 0);
    ASSERT_GE(zeros, 0);
    ASSERT_EQ(ftruncate(zeros, kPiece), 0);
    for (size_t at = 0; at < kBytes; at += kPiece)
        ASSERT_NE(
            mmap(static_cast<std::byte*>(memory) + at, kPiece, PROT_READ, MAP_SHARED | MAP_FIXED, zeros, 0),
            MAP_FAILED);
    close(zeros);
    ts_path path = TS_STRUCT(ts_path);
    path.positions = static_cast<const double*>(memory);
    path.count = kRows;
    path.progress = [](void* context, size_t done, size_t) {
        *static_cast<size_t*>(context) = done;
        return done > 0 ? 1 : 0;
    };
    size_t done = 0, made = 0;
    path.context = &done;
    ts::Handle<ts_hand, ts_hand_close> hand;
    ts::check(ts_hand_create(floorScene(), nullptr, hand.out()));
    expectRefused(ts_hand_touch(hand.get(), &path, nullptr, &made), TS_CANCELLED, "1000000000");
    EXPECT_EQ(done, 4096u);
    EXPECT_EQ(made, 4096u);
    munmap(memory, kBytes);
}

TEST(BadCalls, OfMeshes) {
    ts::Mesh mesh = floorMesh();
    const auto refused = [&](const std::string& part) {
        try {
            (void)ts::Scene({mesh});
            ADD_FAILURE() << "accepted";
        } catch (const ts::Error& error) {
            EXPECT_EQ(error.status(), TS_ARGUMENT) << error.what();
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        }
        mesh = floorMesh();
    };
    mesh.positions[2][1] = NAN;
    refused("meshes[0].positions[7]");
    mesh.triangles[1][2] = 4;
    refused("meshes[0].indices[5]");
    mesh.positions.resize(2);
    refused("meshes[0].vertex_count");
    mesh.positions.clear();
    refused("meshes[0].positions");
    mesh.triangles.clear();
    refused("meshes[0].indices");
    mesh.material = 1;
    refused("meshes[0].material");
    mesh.normals = {{0.0f, 1.0f, 0.0f}};
    refused("normals");
    mesh.normals.assign(4, {0.0f, INFINITY, 0.0f});
    refused("meshes[0].normals");
    ts::Material material;
    material.damping = -1.0;
    EXPECT_THROW((void)ts::Scene({mesh}, {material}), ts::Error);
    EXPECT_THROW((void)ts::Scene(std::vector<ts::Mesh>{}), ts::Error);
    ts_scene scene = nullptr;
    expectRefused(ts_scene_create(nullptr, 1, nullptr, 0, nullptr, &scene), TS_ARGUMENT, "meshes");
    expectRefused(ts_scene_create(nullptr, 1, nullptr, 0, nullptr, nullptr), TS_ARGUMENT, "scene");
    EXPECT_EQ(scene, nullptr);
}

TEST(BadCalls, OfFilesAndSettings) {
    ts_scene scene = nullptr;
    expectRefused(ts_scene_load("/nowhere/at all.glb", nullptr, &scene), TS_INPUT, "remedy");
    expectRefused(ts_scene_load_memory("garbage", 7, nullptr, nullptr, &scene), TS_INPUT, "");
    expectRefused(ts_scene_load_memory(nullptr, 7, nullptr, nullptr, &scene), TS_ARGUMENT, "bytes");
    ts_scene_options options = TS_STRUCT(ts_scene_options);
    options.fit = 7;
    expectRefused(ts_scene_load("x.glb", &options, &scene), TS_ARGUMENT, "options.fit");
    EXPECT_EQ(scene, nullptr);
    ts::Settings settings;
    expectRefused(ts_settings_set(settings.get(), "stiffnes", "3"), TS_ARGUMENT, "there is no setting");
    expectRefused(ts_settings_set(settings.get(), "stiffness", "hard"), TS_ARGUMENT, "allowed: 0 .. ");
    EXPECT_EQ(settings.get("stiffness"), "0");
    ts_recording recording = nullptr;
    expectRefused(ts_recording_open(TOUCHSTONE_ASSETS "/box.glb", &recording), TS_INPUT, "recording");
    // The program says the same.
    const ProgramResult run = runProgram({TOUCHSTONE_BINARY, "touch", TOUCHSTONE_ASSETS "/box.glb", "--set",
                                          "stiffness=hard", "--out", "/dev/null"});
    EXPECT_EQ(run.status, 2);
    (void)ts_settings_set(settings.get(), "stiffness", "hard");
    const std::string message = std::string(ts_last_error()).substr(7); // without "value: "
    EXPECT_NE(run.err.find(message), std::string::npos) << run.err << message;
}

TEST(BadCalls, AfterClose) {
    ts_scene scene = nullptr;
    const ts::Mesh mesh = floorMesh();
    ts_mesh flat = TS_STRUCT(ts_mesh);
    flat.positions = mesh.positions.data()->data();
    flat.vertex_count = 4;
    flat.indices = mesh.triangles.data()->data();
    flat.triangle_count = 2;
    ts::check(ts_scene_create(&flat, 1, nullptr, 0, nullptr, &scene));
    ts_hand hand = nullptr;
    ts::check(ts_hand_create(scene, nullptr, &hand));
    EXPECT_EQ(ts_scene_close(scene), TS_OK);
    expectRefused(ts_scene_close(scene), TS_CLOSED, "scene");
    const std::vector<ts::Vector> rows = press(50);
    const ts_path path = pathOver(rows);
    expectRefused(ts_touch(scene, nullptr, &path, nullptr), TS_CLOSED, "scene");
    EXPECT_EQ(ts_hand_touch(hand, &path, nullptr, nullptr), TS_OK) << "it keeps its scene";
    expectRefused(ts_hand_set(reinterpret_cast<ts_hand>(floorScene()), "stiffness", "1"), TS_CLOSED, "hand");
    expectRefused(ts_hand_set(reinterpret_cast<ts_hand>(~uintptr_t{0}), "stiffness", "1"), TS_CLOSED, "hand");
    EXPECT_EQ(ts_hand_close(hand), TS_OK);
    expectRefused(ts_hand_touch(hand, &path, nullptr, nullptr), TS_CLOSED, "hand");
    EXPECT_EQ(ts_hand_close(nullptr), TS_OK);
}

TEST(BadCalls, OfASession) {
    ts_session session = nullptr;
    expectRefused(ts_session_create(nullptr, &session), TS_ARGUMENT, "options");
    ts_session_options options = TS_STRUCT(ts_session_options);
    expectRefused(ts_session_create(&options, &session), TS_ARGUMENT, "options.device");
    options.device = "stroke:nothing";
    expectRefused(ts_session_create(&options, &session), TS_ARGUMENT, "options.device");
    options.device = "no such device";
    expectRefused(ts_session_create(&options, &session), TS_INPUT, "no such device");
    options.device = "stroke";
    options.rate = 1e9;
    expectRefused(ts_session_create(&options, &session), TS_ARGUMENT, "options.rate");
    options.rate = 0.0;
    ts_device device = TS_STRUCT(ts_device);
    options.device = nullptr;
    options.own = &device;
    expectRefused(ts_session_create(&options, &session), TS_ARGUMENT, "options.own.sample");
    options.device = "stroke";
    options.own = nullptr;
    ts::check(ts_session_create(&options, &session));
    expectRefused(ts_session_start(session), TS_STATE, "ts_session_touch");
    ts_state state = TS_STRUCT(ts_state);
    expectRefused(ts_session_pump(session, &state), TS_STATE, "ts_session_touch");
    ts::check(ts_session_touch(session, floorScene()));
    expectRefused(ts_session_record(session, "/nowhere/x.tsrec"), TS_INPUT, "/nowhere");
    expectRefused(ts_session_run(session, -1.0, 0.0, nullptr, nullptr), TS_ARGUMENT, "seconds");
    expectRefused(ts_session_run(session, 1.0, 0.0, nullptr, nullptr), TS_ARGUMENT, "callback");
    EXPECT_EQ(ts_session_close(session), TS_OK);
    expectRefused(ts_session_start(session), TS_CLOSED, "session");
}

TEST(BadCalls, OfSeveralHands) {
    const ts::Scene scene({floorMesh()});
    ts_hand hands = nullptr;
    expectRefused(ts_hands_create(scene.get(), nullptr, 0, &hands), TS_ARGUMENT, "count");
    expectRefused(ts_hands_create(scene.get(), nullptr, 5, &hands), TS_ARGUMENT, "count");
    expectRefused(ts_hands_create(scene.get(), nullptr, 2, nullptr), TS_ARGUMENT, "hands");
    ts::check(ts_hands_create(scene.get(), nullptr, 2, &hands));
    const std::vector<ts::Vector> positions = press(3);
    const double times[3]{0.0, 1.0, 2.0};
    ts_path paths[2]{TS_STRUCT(ts_path), TS_STRUCT(ts_path)};
    for (ts_path& path : paths) {
        path.positions = positions.front().data();
        path.count = 3;
    }
    expectRefused(ts_hand_touch(hands, paths, nullptr, nullptr), TS_ARGUMENT, "ts_hands_touch");
    expectRefused(ts_hands_touch(hands, paths, nullptr, 1, nullptr), TS_ARGUMENT, "count");
    expectRefused(ts_hands_touch(hands, paths, nullptr, 5, nullptr), TS_ARGUMENT, "count");
    expectRefused(ts_hands_touch(hands, nullptr, nullptr, 2, nullptr), TS_ARGUMENT, "paths");
    paths[1].count = 2;
    expectRefused(ts_hands_touch(hands, paths, nullptr, 2, nullptr), TS_ARGUMENT, "paths[1].count");
    paths[1].count = 3;
    paths[1].times = times;
    expectRefused(ts_hands_touch(hands, paths, nullptr, 2, nullptr), TS_ARGUMENT, "paths[1].times");
    paths[1].times = nullptr;
    paths[1].positions = nullptr;
    expectRefused(ts_hands_touch(hands, paths, nullptr, 2, nullptr), TS_ARGUMENT, "paths[1].positions");
    paths[1].positions = paths[0].positions;
    double force[6];
    ts_ticks ticks[2]{TS_STRUCT(ts_ticks), TS_STRUCT(ts_ticks)};
    ticks[1].force = force;
    ticks[1].capacity = 2;
    expectRefused(ts_hands_touch(hands, paths, ticks, 2, nullptr), TS_ARGUMENT, "capacity");
    paths[0].times = times;
    size_t done = 0;
    ts::check(ts_hands_touch(hands, paths, nullptr, 2, &done));
    EXPECT_EQ(done, 3u);
    EXPECT_EQ(ts_hand_close(hands), TS_OK);
    expectRefused(ts_hands_touch(hands, paths, nullptr, 2, nullptr), TS_CLOSED, "hand");
}

TEST(BadCalls, OfASessionOfSeveralHands) {
    ts_session session = nullptr;
    ts_session_options options = TS_STRUCT(ts_session_options);
    options.device = "stroke";
    options.other_count = 1;
    expectRefused(ts_session_create(&options, &session), TS_ARGUMENT, "options.others");
    ts_other_hand others[4]{TS_STRUCT(ts_other_hand), TS_STRUCT(ts_other_hand), TS_STRUCT(ts_other_hand),
                            TS_STRUCT(ts_other_hand)};
    options.others = others;
    expectRefused(ts_session_create(&options, &session), TS_ARGUMENT, "options.others[0].device");
    others[0].device = "stroke:nothing";
    expectRefused(ts_session_create(&options, &session), TS_ARGUMENT, "options.others[0].device");
    others[0].device = "stroke";
    options.other_count = 4;
    expectRefused(ts_session_create(&options, &session), TS_ARGUMENT, "options.other_count");
    options.other_count = 1;
    options.control = 1000.0;
    expectRefused(ts_session_create(&options, &session), TS_ARGUMENT, "control loop");
    options.control = 0.0;
    const ts_device own = TS_STRUCT(ts_device);
    others[0].own = &own;
    expectRefused(ts_session_create(&options, &session), TS_ARGUMENT, "options.others[0].device");
    others[0].device = nullptr;
    expectRefused(ts_session_create(&options, &session), TS_ARGUMENT, "options.others[0].own.sample");
    others[0] = TS_STRUCT(ts_other_hand);
    others[0].device = "stroke";
    ts::check(ts_session_create(&options, &session));
    ts_state state = TS_STRUCT(ts_state);
    expectRefused(ts_session_hand(session, 0, &state), TS_STATE, "ts_session_touch");
    expectRefused(ts_session_hand(session, 2, &state), TS_ARGUMENT, "there are 2");
    expectRefused(ts_session_hand(session, 0, nullptr), TS_STATE, "ts_session_touch");
    ts_ticks ticks = TS_STRUCT(ts_ticks);
    size_t count = 0;
    expectRefused(ts_session_take_hand(session, 2, &ticks, &count), TS_ARGUMENT, "there are 2");
    EXPECT_EQ(ts_session_close(session), TS_OK);
}

/// Threads share a hand, and scenes close under them.
TEST(BadCalls, FromManyThreadsAtOnce) {
    ts::Scene scene({floorMesh()});
    ts::Handle<ts_hand, ts_hand_close> hand;
    ts::check(ts_hand_create(scene.get(), nullptr, hand.out()));
    std::atomic<int> touched{0}, closed{0};
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&, t] {
            const std::vector<ts::Vector> rows = press(200);
            const ts_path path = pathOver(rows);
            for (int i = 0; i < 50; ++i) {
                if (t == 0 && i == 25)
                    (void)ts_scene_close(scene.get());
                const ts_status one = ts_hand_touch(hand.get(), &path, nullptr, nullptr);
                EXPECT_EQ(one, TS_OK) << ts_last_error();
                const ts_status other = ts_touch(scene.get(), nullptr, &path, nullptr);
                EXPECT_TRUE(other == TS_OK || other == TS_CLOSED) << ts_last_error();
                ++(other == TS_OK ? touched : closed);
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_GT(touched, 0);
    EXPECT_GT(closed, 0);
}

} // namespace
} // namespace touchstone::test

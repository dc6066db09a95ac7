// What a caller changes of a scene while it is touched: materials and where objects are.

#include "tests/support/program.h"
#include "tests/unit/api/pressing.h"

#include <gtest/gtest.h>

#include <algorithm>
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

/// Three squares side by side as a .gltf, the middle one of which the hand touches.
struct Squares {
    std::string materials = R"({"name":"one"})";
    std::string of[3]{R"(,"material":0)", "", ""}; ///< members of each square's primitive
    std::string nodes[3];                          ///< members of its node
    std::string root;                              ///< of the file
};

/// The first one has material 0, the others have none.
std::filesystem::path threeSquares(const ScratchFolder& folder, const Squares& squares = {}) {
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
    text << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2]}],"materials":[)"
         << squares.materials << R"(],"buffers":[{"uri":"squares.bin","byteLength":156}],
"bufferViews":[{"buffer":0,"byteLength":144},{"buffer":0,"byteOffset":144,"byteLength":12}],"nodes":[)";
    for (int i = 0; i < 3; ++i)
        text << (i > 0 ? "," : "") << R"({"mesh":)" << i << squares.nodes[i] << "}";
    text << R"(],"meshes":[)";
    for (int i = 0; i < 3; ++i)
        text << (i > 0 ? "," : "") << R"({"primitives":[{"attributes":{"POSITION":)" << i
             << R"(},"indices":3)" << squares.of[i] << "}]}";
    text << R"(],"accessors":[)";
    for (int i = 0; i < 3; ++i)
        text << R"({"bufferView":0,"byteOffset":)" << 48 * i
             << R"(,"componentType":5126,"count":4,"type":"VEC3","min":[)" << corners[12 * i]
             << ",0,-0.05],\"max\":[" << corners[12 * i] + 0.05f << ",0,0.05]},";
    text << R"({"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}])" << squares.root << "}";
    return folder / "squares.gltf";
}

TEST(LiveChanges, ChangesAMaterialWhileItIsTouched) {
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

TEST(LiveChanges, ARecordingHasChangesOfSurfacesThatTheFileHasNoMaterialFor) {
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

/// A square of the same material in the file with a friction of its own (KHR_physics_rigid_bodies) is another
/// material of the scene: 1. What is changed of one of them changes of both, since a recording knows the
/// file's alone, also while their object moves.
TEST(LiveChanges, MaterialsOfOneIndexChangeTogether) {
    const ScratchFolder folder;
    Squares squares;
    squares.of[1] = squares.of[2] = squares.of[0];
    squares.nodes[1] = R"(,"extensions":{"KHR_physics_rigid_bodies":{"collider":{"physicsMaterial":0}}})";
    squares.root = R"(,"extensionsUsed":["KHR_physics_rigid_bodies"],"extensions":{"KHR_physics_rigid_bodies":
{"physicsMaterials":[{"staticFriction":0.75,"dynamicFriction":0.5}]}})";
    const std::string model = threeSquares(folder, squares).string(),
                      file = (folder / "changed.tsrec").string();
    PressedSession pressed;
    ts_session session = pressed.handle.get();
    double value = 0.0;
    EXPECT_EQ(ts_session_material_number(session, 0, "stiffness", &value), TS_STATE);
    const ts::Scene scene(model, TS_FIT_NONE);
    ASSERT_EQ(scene.info().materials, 2u);
    ts::check(ts_session_touch(session, scene.get()));
    const auto felt = [&](uint64_t material, const char* name) {
        ts::check(ts_session_material_number(session, material, name, &value));
        return value;
    };
    const auto change = [&](uint64_t material, const char* name, double to) {
        ts::check(ts_session_material(session, material, name, to));
    };
    EXPECT_EQ(felt(1, "staticFriction"), 0.75);
    const double plain = felt(0, "staticFriction");
    EXPECT_NE(plain, 0.75);
    ts::check(ts_session_record(session, file.c_str()));
    ts::check(ts_session_start(session));
    const ts_state& state = pressed.state;
    const auto touches = [&](double newtons) {
        return pressed.until([&] { return state.contacts > 0 && std::abs(state.force[1] - newtons) < 1e-3; });
    };
    EXPECT_TRUE(touches(1.2)); // 600 N/m, 2 mm deep, on the middle square
    change(0, "stiffness", 100.0);
    EXPECT_TRUE(touches(0.2));
    EXPECT_EQ(felt(1, "stiffness"), 100.0);
    change(1, "stiffness", 300.0);
    EXPECT_TRUE(touches(0.6));
    EXPECT_EQ(felt(0, "stiffness"), 300.0);

    ts_pose pose = TS_STRUCT(ts_pose);
    const auto object = static_cast<uint64_t>(state.object);
    ts_object_info info = TS_STRUCT(ts_object_info);
    ts::check(ts_scene_object(scene.get(), object, &info));
    std::copy(info.centre, info.centre + 3, pose.position);
    pose.position[1] += 0.001; // 3 mm deep
    ts::check(ts_session_move(session, object, &pose));
    EXPECT_TRUE(touches(0.9));
    change(0, "stiffness", 200.0);
    EXPECT_TRUE(touches(0.6));
    change(1, "staticFriction", 0.25);
    EXPECT_EQ(felt(0, "staticFriction"), 0.25);
    change(0, "staticFriction", NAN); // each says what it said
    EXPECT_EQ(felt(1, "staticFriction"), 0.75);
    EXPECT_TRUE(std::isnan(plain) ? std::isnan(felt(0, "staticFriction"))
                                  : felt(0, "staticFriction") == plain)
        << value;
    EXPECT_TRUE(touches(0.6)) << "the stiffness stays, and the object where it was moved";
    change(1, "stiffness", NAN);
    EXPECT_TRUE(touches(1.8));
    ts::check(ts_session_record(session, nullptr));
    ts::check(ts_session_stop(session));
    EXPECT_EQ(ts_session_material_number(session, 2, "stiffness", &value), TS_ARGUMENT);
    EXPECT_EQ(ts_session_material_number(session, 0, "hardness", &value), TS_ARGUMENT);
    EXPECT_EQ(ts_session_material_number(session, 0, "stiffness", nullptr), TS_ARGUMENT);
    const ProgramResult replay = runProgram({TOUCHSTONE_BINARY, "replay", file});
    EXPECT_EQ(replay.status, 0) << replay.out << replay.err;
}

TEST(LiveChanges, MovesAnObjectUnderTheHandAndRecordsIt) {
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
    const auto ticksGoOn = [&] { // by more than the few that may not know of the last call
        ts::check(ts_session_pump(session, &state));
        const uint64_t seen = state.ticks;
        return until([&] { return state.ticks > seen + 20; });
    };
    ts::check(ts_session_halt(session));
    EXPECT_TRUE(ticksGoOn());
    ts::check(ts_session_pose(session, object, &now));
    ts_pose later = TS_STRUCT(ts_pose);
    EXPECT_TRUE(ticksGoOn());
    ts::check(ts_session_pose(session, object, &later));
    EXPECT_EQ(later.position[1], now.position[1]);
    EXPECT_LT(now.position[1], 0.1);
    ts::check(
        ts_session_material(session, 0, "stiffness", 400.0)); // its motion outlives a change of materials
    EXPECT_TRUE(ticksGoOn());
    ts::check(ts_session_pose(session, object, &later));
    EXPECT_EQ(later.position[1], now.position[1]);
    ts::check(ts_session_record(session, nullptr));
    ts::check(ts_session_stop(session));
    EXPECT_LE(pressing.largest, 1.0 + 1e-12);
    const ProgramResult replay = runProgram({TOUCHSTONE_BINARY, "replay", file});
    EXPECT_EQ(replay.status, 0) << replay.out << replay.err;
}

/// More ticks take goals than there is room for their states, and nobody pumps: none is lost.
TEST(LiveChanges, RecordsEveryGoalWithoutAPump) {
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
    // Of goals within one tick the newest counts: so many ticks must have been made meanwhile.
    const int ticks = pressing.samples + 3100;
    for (int goal = 0; goal < 100'000 && (goal < 6000 || pressing.samples < ticks); ++goal) {
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

} // namespace
} // namespace touchstone::test

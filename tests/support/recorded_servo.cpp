#include "tests/support/recorded_servo.h"

#include "engine/core/float_mode.h"
#include "engine/load/scene_loader.h"
#include "haptics/scene/scene_parts.h"
#include "haptics/tick/stepped_hand.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <thread>

namespace touchstone::test {

namespace {

/// Rounding of a sum of forces, N.
constexpr double kRounding = 1e-9;

void pause() {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

std::vector<DevicePort> portsOf(std::vector<RecordedServo::Hand>& hands) {
    std::vector<DevicePort> ports;
    for (RecordedServo::Hand& hand : hands)
        ports.push_back({.context = &hand,
                         .sample =
                             [](void* context, double time) noexcept {
                                 return (*static_cast<RecordedServo::Hand*>(context))(time);
                             },
                         .apply = [](void*, const DeviceCommand&) noexcept {}});
    return ports;
}

} // namespace

TouchedScene touchedScene(const std::string& file) {
    TouchedScene scene;
    LoadOptions options;
    options.images.visual = false;
    scene.source = loadScene(std::filesystem::path(TOUCHSTONE_ASSETS) / file, options);
    scene.haptic = compileHapticScene(*scene.source, workspaceFromScene(*scene.source, Fit::Workspace));
    scene.identity = identify(*scene.haptic, *scene.source, Fit::Workspace);
    return scene;
}

TouchedScene floorScene(float height) {
    auto source = std::make_shared<Scene>();
    Mesh mesh;
    mesh.positions = {
        {-0.05f, height, -0.05f}, {-0.05f, height, 0.05f}, {0.05f, height, 0.05f}, {0.05f, height, -0.05f}};
    mesh.normals.assign(4, {0.0f, 1.0f, 0.0f});
    mesh.indices = {0, 1, 2, 0, 2, 3};
    source->path = "floor";
    source->meshes.push_back(std::move(mesh));
    source->materials.emplace_back();
    source->nodes.emplace_back();
    source->instances.push_back({.node = 0, .mesh = 0});
    TouchedScene scene;
    scene.haptic = compileHapticScene(*source, Similarity{});
    scene.source = std::move(source);
    scene.identity = identify(*scene.haptic, *scene.source, Fit::None);
    return scene;
}

TouchedScene withChanged(const TouchedScene& scene, const std::function<void(HapticMaterial&)>& change) {
    auto source = std::make_shared<Scene>(*scene.source);
    for (Material& material : source->materials)
        change(material.haptic);
    TouchedScene changed = scene;
    changed.haptic = withMaterials(*scene.haptic, *scene.source, scene.source->materials, source->materials);
    changed.identity.feltHash = feltHash(*changed.haptic, *source);
    changed.source = std::move(source);
    return changed;
}

TouchedScene floorOf(float height, float stiffness) {
    return withChanged(floorScene(height),
                       [&](HapticMaterial& material) { material.stiffness.value = stiffness; });
}

glm::dvec3 overTheDoughnut(double time) {
    // Fitted, its ring has a radius of 52.9 mm and its tube one of 22.1 mm, about the z axis.
    // Comes from outside: a hand that starts inside or within reach (5 mm) feels nothing.
    const double a = 1.7 * time,
                 lift = 0.0209 + 0.0015 * std::sin(23.0 * time) + 0.008 * std::exp(-30.0 * time);
    return {0.0529 * std::cos(a), 0.0529 * std::sin(a), lift};
}

DeviceSample at(const glm::dvec3& position) {
    return sampleAt(position);
}

RecordedServo::RecordedServo(std::vector<Hand> hands, const ServoConfig& config)
    : hands_(std::move(hands)), servo(portsOf(hands_), config), recorder(servo) {}

RecordedServo::~RecordedServo() {
    servo.stop();
}

void RecordedServo::offer(const TouchedScene& scene, SceneSwap swap) {
    scenes.push_back(scene);
    recorder.sceneOffered(servo.offerScene(scene.haptic, scene.source, swap), scene.identity);
}

void RecordedServo::drain() {
    TickRecord record;
    while (servo.popRecord(record)) {
        recorder.take(record);
        (record.hand == 0 ? records : others).push_back(record);
    }
    recorder.flush();
    servo.updateSnapshot();
}

void RecordedServo::ticks(uint64_t count, const std::function<void()>& each) {
    const uint64_t goal = servo.counters().ticks + count;
    servo.start();
    while (servo.counters().ticks < goal) {
        if (each)
            each();
        drain();
        pause();
    }
    drain();
}

void RecordedServo::steps(uint64_t count) {
    constexpr uint64_t kBatch = 64; // ticks; the ring holds more
    enterFloatMode();
    for (uint64_t i = 0; i < count; ++i) {
        (void)servo.step(servo.counters().ticks);
        if (i % kBatch == kBatch - 1)
            drain();
    }
    drain();
}

void RecordedServo::ticksUnread(uint64_t count) {
    const uint64_t goal = servo.counters().ticks + count;
    servo.start();
    while (servo.counters().ticks < goal)
        pause();
}

void RecordedServo::finish() {
    servo.stop();
    drain();
    recorder.finish();
}

void RecordedServo::expectWithinLimits() const {
    expectWithin(records);
    for (uint32_t hand = 1; hand < servo.hands(); ++hand) {
        std::vector<TickRecord> own;
        std::ranges::copy_if(others, std::back_inserter(own),
                             [&](const TickRecord& record) { return record.hand == hand; });
        expectWithin(own);
    }
}

void RecordedServo::expectWithin(const std::vector<TickRecord>& records) {
    glm::dvec3 last(0.0);
    for (size_t i = 0; i < records.size(); ++i) {
        const TickRecord& record = records[i];
        const DeviceLimits& limits = record.sample.limits;
        const glm::dvec3 force = record.output.command.force();
        ASSERT_TRUE(std::isfinite(force.x) && std::isfinite(force.y) && std::isfinite(force.z))
            << "tick " << i;
        ASSERT_LE(glm::length(force), limits.maxForce) << "tick " << i;
        // A run begins with nothing held, and so does what follows ticks that were not read.
        const bool goesOn =
            i > 0 && record.step == records[i - 1].step + 1 && record.tick > records[i - 1].tick;
        if (goesOn && record.scene > 0 && !has(record.output.flags, TickFlag::ForceFault)) {
            ASSERT_LE(glm::length(force - last), limits.maxForceRate * record.dt + kRounding) << "tick " << i;
        }
        last = force;
    }
}

size_t RecordedServo::countOf(TickFlag flag) const {
    return static_cast<size_t>(
        std::count_if(records.begin(), records.end(),
                      [flag](const TickRecord& record) { return has(record.output.flags, flag); }));
}

size_t RecordedServo::inContact() const {
    return static_cast<size_t>(std::count_if(
        records.begin(), records.end(), [](const TickRecord& record) { return record.output.contacts > 0; }));
}

ReplayReport replayOf(const std::filesystem::path& file, const std::vector<TouchedScene>& scenes) {
    RecordingReader reader(file);
    Replayer replayer([&](const RecordedScene& scene) {
        // Compiled anew, as another process would: nothing that the first run built is there.
        const TouchedScene& offered = scenes.at(scene.number - 1);
        const auto whole = compileHapticScene(*offered.source, offered.haptic->workspaceFromScene);
        const auto haptic = partOf(*whole, *offered.source, scene.identity.part);
        EXPECT_EQ(feltHash(*haptic, *offered.source), scene.identity.feltHash);
        return ReplayScene{haptic, offered.source};
    });
    return replayer.replay(reader);
}

void expectEqualReplay(const ReplayReport& report) {
    EXPECT_FALSE(report.first.has_value())
        << "tick " << report.first->tick << " differs in the stage " << report.first->stage;
    EXPECT_EQ(report.differing, 0u);
    EXPECT_EQ(report.replayed, report.ticks);
    EXPECT_GT(report.replayed, 0u);
    EXPECT_TRUE(report.damage.empty());
}

std::vector<RecordedItem> itemsOf(const std::filesystem::path& file) {
    RecordingReader reader(file);
    std::vector<RecordedItem> items;
    while (auto item = reader.next())
        items.push_back(std::move(item->item));
    return items;
}

void writeItems(const std::filesystem::path& file, const std::vector<RecordedItem>& items) {
    RecordingFile out(file);
    for (const RecordedItem& item : items)
        out.append(item);
}

} // namespace touchstone::test

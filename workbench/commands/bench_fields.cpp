#include "workbench/commands/bench_fields.h"

#include "assets/shapes.h"
#include "haptics/shape/field/mesh_to_field.h"
#include "study/timing/bench_scene.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

namespace touchstone {

namespace {

constexpr int kNodes = 150;               // across each side of the mesh
constexpr double kBound = 0.5;            // s
constexpr int kInside = 20, kOutside = 7; // voxels: as deep as a device of 8.5 N asks

/// A torus of 60 and 25 mm that is stretched along its axis until it is as high as it is wide: it fills the
/// cube of nodes. An odd number of points around the tube leaves none on the cube's faces.
assets::Shape highTorus(uint32_t aroundRing, uint32_t aroundTube) {
    constexpr double kRing = 0.06, kTube = 0.025;
    assets::Shape torus = assets::torus(kRing, kTube, aroundRing, aroundTube);
    for (glm::vec3& p : torus.positions)
        p.z *= static_cast<float>((kRing + kTube) / kTube);
    torus.normals.clear(); // of the torus before
    return torus;
}

double processorSeconds() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

struct FieldCase {
    BenchScene scene;
    FieldRequest request{};
    std::vector<double> seconds{}, processor{};
    size_t bytes = 0;
};

FieldCase caseOf(uint32_t aroundRing, uint32_t aroundTube) {
    FieldCase made{.scene = shapeScene("torus", highTorus(aroundRing, aroundTube), {})};
    const HapticObject& mesh = *made.scene.haptic->objects.front();
    glm::vec3 low(INFINITY), high(-INFINITY);
    for (const glm::vec3& p : mesh.vertices) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const double voxel = static_cast<double>(high.x - low.x) / (kNodes - 1);
    made.request = {.voxel = voxel, .inside = kInside * voxel, .outside = kOutside * voxel};
    return made;
}

void build(FieldCase& field) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    const double processor = processorSeconds();
    const auto grid = fieldOfMesh(*field.scene.haptic->objects.front(), field.request);
    field.processor.push_back(processorSeconds() - processor);
    field.seconds.push_back(std::chrono::duration<double>(Clock::now() - begin).count());
    field.bytes = grid->memoryBytes();
}

} // namespace

nlohmann::ordered_json benchFields(const BenchOptions& options, size_t& missed) {
    std::array<FieldCase, 2> fields{caseOf(52, 32), caseOf(77, 77)};
    const int rounds = std::max(1, options.rounds / 2);
    for (int round = 0; round < rounds; ++round)
        for (FieldCase& field : fields)
            build(field);
    std::printf("| distance field of a mesh, %d³ nodes | built in, s | of processor, s | memory, MB "
                "|\n|---|---|---|---|\n",
                kNodes);
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const FieldCase& field : fields) {
        const double seconds = median(field.seconds), processor = median(field.processor);
        missed += seconds <= kBound ? 0 : 1;
        std::printf("| %zu triangles | %.2f of %.1f, %s | %.2f | %.0f |\n", field.scene.triangles(), seconds,
                    kBound, seconds <= kBound ? "met" : "MISSED", processor,
                    1e-6 * static_cast<double>(field.bytes));
        json.push_back({{"triangles", field.scene.triangles()},
                        {"nodes_across", kNodes},
                        {"rounds", rounds},
                        {"seconds_p50", seconds},
                        {"seconds", field.seconds},
                        {"processor_seconds_p50", processor},
                        {"bytes", field.bytes}});
    }
    std::printf("\n");
    return json;
}

} // namespace touchstone

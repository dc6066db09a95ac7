#include "tests/support/touch_bench.h"

#include "haptics/scene/scene_programs.h"
#include "haptics/tick/stepped_hand.h"

#include <cmath>
#include <utility>

namespace touchstone::test {

namespace {

Mesh meshOf(const assets::Shape& shape) {
    Mesh mesh;
    if (shape.normals.empty()) {
        // Flat: every triangle has its own corners.
        for (size_t t = 0; t < shape.triangleCount(); ++t) {
            const glm::dvec3 a(shape.positions[shape.indices[3 * t]]),
                b(shape.positions[shape.indices[3 * t + 1]]), c(shape.positions[shape.indices[3 * t + 2]]);
            const glm::dvec3 area = glm::cross(b - a, c - a);
            const double length = glm::length(area);
            for (size_t k = 0; k < 3; ++k) {
                mesh.positions.push_back(shape.positions[shape.indices[3 * t + k]]);
                mesh.normals.push_back(length > 0.0 ? glm::vec3(area / length) : glm::vec3(0, 1, 0));
                mesh.indices.push_back(static_cast<uint32_t>(3 * t + k));
            }
        }
        return mesh;
    }
    mesh.positions = shape.positions;
    mesh.normals = shape.normals;
    mesh.uv0 = shape.uv;
    mesh.tangents = shape.tangents;
    mesh.indices = shape.indices;
    mesh.normalsFromFile = true;
    mesh.tangentsFromFile = !shape.tangents.empty();
    return mesh;
}

} // namespace

void addShape(Scene& scene, const assets::Shape& shape, const glm::dmat4& sceneFromMesh) {
    Instance instance;
    instance.node = static_cast<int>(scene.nodes.size());
    instance.mesh = static_cast<int>(scene.meshes.size());
    instance.sceneFromMesh = sceneFromMesh;
    scene.nodes.emplace_back();
    scene.meshes.push_back(meshOf(shape));
    scene.instances.push_back(instance);
    for (const glm::vec3& p : scene.meshes.back().positions)
        scene.bounds.include(glm::dvec3(sceneFromMesh * glm::dvec4(glm::dvec3(p), 1.0)));
}

Scene sceneOf(const assets::Shape& shape, const glm::dmat4& sceneFromMesh) {
    Scene scene;
    scene.path = "bench";
    scene.materials.emplace_back();
    addShape(scene, shape, sceneFromMesh);
    return scene;
}

TouchBench::TouchBench(const Scene& from, const HapticSettings& chosen, Fit fit)
    : TouchBench(compileHapticScene(from, workspaceFromScene(from, fit)), chosen) {}

TouchBench::TouchBench(std::shared_ptr<const HapticScene> compiled, const HapticSettings& chosen)
    : settings(chosen), scene(std::move(compiled)), state(1) {
    world.shareTextures(persistentTextures(*scene));
}

const HapticOutput& TouchBench::step(const glm::dvec3& hip) {
    DeviceSample sample = sampleAt(hip);
    sample.mapping = mapping;
    sample.limits = limits;
    TickInput input;
    input.tick = tick;
    input.time = static_cast<double>(tick) * dt;
    input.dt = dt;
    input.hands = {&sample, 1};
    world.place(motions);
    NoStopwatch none;
    hapticStep(*scene, settings, input, world, state, {&output, 1}, none);
    ++tick;
    return output;
}

const HapticOutput& TouchBench::moveTo(const glm::dvec3& to, double speed,
                                       const std::function<void(const HapticOutput&)>& each) {
    const glm::dvec3 from = tick == 0 ? to : output.hip;
    const int ticks = std::max(1, static_cast<int>(std::ceil(glm::length(to - from) / (speed * dt))));
    for (int i = 1; i <= ticks; ++i) {
        step(from + (to - from) * (static_cast<double>(i) / ticks));
        if (each)
            each(output);
    }
    return output;
}

} // namespace touchstone::test

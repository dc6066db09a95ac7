#include "tests/property/exact_cases.h"

#include "engine/load/scene_loader.h"
#include "tests/support/surface_hand.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>

namespace touchstone::test {

std::vector<HandCase> handsOver(const std::string& name, int ticks, double compared) {
    std::vector<HandCase> hands;
    for (const double radius : {0.0, 0.5e-3}) {
        const std::string r = radius > 0.0 ? " r.5" : " r0";
        hands.push_back({name + r + " 0.1 m/s", radius, 0.1, ticks, compared});
        hands.push_back({name + r + " 1 m/s", radius, 1.0, ticks, compared});
        hands.push_back({name + r + " taps", radius, 0.3, ticks / 2, compared, true});
    }
    return hands;
}

ExactFigures runStroke(const StrokeCase& c, int ticks) {
    const Scene source = sceneOf(c.shape);
    const double fitted = workspaceFromScene(source, Fit::Workspace).scale;
    ExactScene scene(source, Fit::None);
    char speed[32];
    std::snprintf(speed, sizeof speed, " %g m/s", c.speed);
    ExactTrial trial(c.name + (c.radius > 0.0 ? " r.5" : " r0") + speed, scene,
                     {.radius = c.radius * fitted});
    trial.tick({0.2, 0.0, 0.0}, false);
    trial.forget();
    trial.tick(1.5 * strokeHand(c, 0));
    for (int i = 0; i < ticks; ++i)
        trial.tick(strokeHand(c, i));
    trial.forget();
    return trial.figures();
}

ExactFigures runHand(const HandCase& c, ExactScene& scene) {
    ExactTrial trial(c.name, scene, {.radius = c.radius, .freeRunning = c.compared >= 1.0});
    const Similarity& placed = scene.haptic()->objects[0]->workspaceFromObject;
    const LSimilarity workspaceFromObject(placed);
    const double unit = placed.scale / scene.workspacePerFitted();
    SurfaceHand hand(scene.soup(0), unit, {.speed = c.speed, .length = c.taps ? 0.0 : 8e-3}, 7);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    // A stroke that starts inside a closed object or between two sheets is felt by nobody.
    for (int strokes = 0; strokes < 40 * c.ticks && trial.figures().ticks < c.ticks; ++strokes) {
        for (const LVec3& hip : hand.stroke()) {
            trial.tick(glm::dvec3(workspaceFromObject.point(hip)), share(random) < c.compared);
            if (!trial.placed())
                break;
        }
        trial.forget();
    }
    return trial.figures();
}

std::vector<ExactFigures> runHands(const std::vector<HandCase>& hands, const Scene& scene) {
    ExactScene exact(scene, Fit::Workspace);
    std::vector<ExactFigures> all;
    for (const HandCase& c : hands)
        all.push_back(runHand(c, exact));
    return all;
}

long double vertexError(const Scene& source, Fit fit) {
    const auto scene = compileHapticScene(source, workspaceFromScene(source, fit));
    const LSimilarity toWorkspace(scene->workspaceFromScene);
    long double worst = 0.0L;
    for (const auto& object : scene->objects) {
        const Instance& instance = source.instances[static_cast<size_t>(object->instance)];
        const Mesh& mesh = source.meshes[static_cast<size_t>(instance.mesh)];
        const glm::mat<4, 4, long double> sceneFromMesh(instance.sceneFromMesh);
        const LSimilarity workspaceFromObject(object->workspaceFromObject);
        const auto diagonal = static_cast<long double>(object->diagonal * object->workspaceFromObject.scale);
        for (size_t i = 0; i < object->indices.size(); ++i) {
            const LVec3 there(sceneFromMesh * glm::vec<4, long double>(
                                                  LVec3(mesh.positions[object->sourceIndices[i]]), 1.0L));
            const LVec3 here = workspaceFromObject.point(LVec3(object->vertices[object->indices[i]]));
            worst = std::max(worst, glm::length(here - toWorkspace.point(there)) / diagonal);
        }
    }
    return worst;
}

Scene asMeshes(Scene scene) {
    for (Material& material : scene.materials)
        material.haptic.implicit = false;
    return scene;
}

std::vector<ExactFigures> runFile(const std::filesystem::path& file, int ticks) {
    LoadOptions options;
    options.images = {.visual = false, .haptic = false};
    const Scene scene = asMeshes(*loadScene(file, options));
    // Welding moves a vertex by at most its tolerance.
    EXPECT_LT(vertexError(scene, Fit::Workspace), 1.1e-6L) << file;
    return runHands(handsOver(file.stem().string(), ticks), scene);
}

void expectExact(const std::string& name, const std::vector<ExactFigures>& all) {
    std::printf("%s\n", exactHead().c_str());
    ASSERT_FALSE(all.empty());
    for (const ExactFigures& f : all)
        std::printf("%s\n", exactLine(f).c_str());
    std::printf("%s\n", exactLine(together("= " + name, all)).c_str());
    for (const ExactFigures& f : all)
        for (const std::string& line : f.divergences)
            std::printf("%s\n", line.c_str());
    std::fflush(stdout);
    for (const ExactFigures& f : all) {
        SCOPED_TRACE(f.name);
        EXPECT_GT(f.touching, f.ticks / 4);
        for (size_t i = 0; i < std::min<size_t>(f.faults.size(), 5); ++i)
            ADD_FAILURE() << f.faults[i] << (i == 4 ? ", and more" : "");
        // Where two ends parted, the oracle's too is free and a rest.
        EXPECT_LE(f.oracleShortfall, 0.0L);
        EXPECT_LT(f.oracleCone, 1e-9L);
    }
}

} // namespace touchstone::test

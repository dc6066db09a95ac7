#include "study/perception/reduced_model.h"

#include "engine/core/error.h"
#include "haptics/query/surface_distance.h"
#include "haptics/scene/haptic_scene.h"
#include "study/perception/perceptual_check.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace touchstone::study {

namespace {

constexpr double kReducedLevel = 0.70710678; // of the triangles, from one level to the next
constexpr size_t kPlaces = 20'000;           // of each surface, besides its vertices
constexpr size_t kVertices = 50'000;         // of each surface, at most

/// Without normals of the file every facet has vertices of its own, which meshoptimizer would keep as seams:
/// such a mesh is its positions alone.
void weldFlat(Mesh& mesh) {
    const bool stated = !mesh.uv0.empty() || !mesh.colors.empty() || !mesh.stiffness.empty() ||
                        !mesh.damping.empty() || !mesh.friction.empty() || !mesh.heights.empty();
    if (mesh.normalsFromFile || stated || mesh.positions.empty())
        return;
    std::vector<uint32_t> place(mesh.positions.size());
    const size_t places =
        meshopt_generateVertexRemap(place.data(), nullptr, mesh.positions.size(), mesh.positions.data(),
                                    mesh.positions.size(), sizeof(glm::vec3));
    std::vector<glm::vec3> positions(places);
    for (size_t v = 0; v < place.size(); ++v)
        positions[place[v]] = mesh.positions[v];
    for (uint32_t& corner : mesh.indices)
        corner = place[corner];
    mesh.positions = std::move(positions);
    mesh.normals.clear();
    mesh.tangents.clear();
    mesh.uv1.clear();
    mesh.lineIndices.clear();
    mesh.pointIndices.clear();
}

std::shared_ptr<Scene> atRest(const Scene& scene) {
    auto copy = std::make_shared<Scene>(scene);
    copy->animations.clear();
    copy->volume.reset(); // as triangles, as is what is felt as a field
    for (Material& material : copy->materials)
        material.haptic.implicit = false;
    for (Mesh& mesh : copy->meshes) {
        mesh.deformation.reset();
        mesh.sources.clear();
        weldFlat(mesh);
    }
    return copy;
}

/// Each mesh to a share of its triangles. False where none has fewer afterwards.
bool reduce(Scene& scene) {
    bool any = false;
    for (Mesh& mesh : scene.meshes) {
        if (mesh.indices.size() < 6)
            continue;
        const auto wanted =
            3 * static_cast<size_t>(kReducedLevel * static_cast<double>(mesh.triangleCount()));
        std::vector<uint32_t> fewer(mesh.indices.size());
        fewer.resize(meshopt_simplify(fewer.data(), mesh.indices.data(), mesh.indices.size(),
                                      &mesh.positions[0].x, mesh.positions.size(), sizeof(glm::vec3), wanted,
                                      1.0f, 0, nullptr));
        if (fewer.empty() || fewer.size() >= mesh.indices.size())
            continue;
        mesh.indices = std::move(fewer);
        any = true;
    }
    return any;
}

/// Places of a scene's surface, workspace: vertices, and random ones, by area.
std::vector<glm::dvec3> placesOf(const HapticScene& scene) {
    std::vector<glm::dvec3> places, corners;
    std::vector<double> areas;
    for (const auto& object : scene.objects) {
        if (object->shape != nullptr)
            continue;
        for (const uint32_t index : object->indices)
            corners.push_back(object->workspaceFromObject.point(glm::dvec3(object->vertices[index])));
    }
    for (size_t i = 0; i + 2 < corners.size(); i += 3)
        areas.push_back((areas.empty() ? 0.0 : areas.back()) +
                        glm::length(glm::cross(corners[i + 1] - corners[i], corners[i + 2] - corners[i])));
    const size_t stride = std::max<size_t>(1, corners.size() / kVertices);
    for (size_t i = 0; i < corners.size(); i += stride)
        places.push_back(corners[i]);
    if (areas.empty() || !(areas.back() > 0.0))
        return places;
    std::mt19937_64 random(20);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (size_t i = 0; i < kPlaces; ++i) {
        const auto found = std::ranges::lower_bound(areas, unit(random) * areas.back());
        const size_t t = static_cast<size_t>(std::min(found, areas.end() - 1) - areas.begin());
        const double u = std::sqrt(unit(random)), v = unit(random);
        places.push_back((1.0 - u) * corners[3 * t] + u * (1.0 - v) * corners[3 * t + 1] +
                         u * v * corners[3 * t + 2]);
    }
    return places;
}

/// The ball of the query grows until it holds the nearest triangle: a large one is slow.
double distanceTo(const HapticScene& scene, const glm::dvec3& point, double& ball) {
    for (;; ball *= 4.0)
        if (const double distance = surfaceDistance(scene, {}, point, ball); distance < ball)
            return distance;
}

void measure(const HapticScene& whole, const HapticScene& reduced, double scale, ReducedModel& model) {
    double sum = 0.0;
    const auto from = [&](const HapticScene& places, const HapticScene& other) {
        for (const glm::dvec3& place : placesOf(places)) {
            double ball = 1e-4;
            const double distance = distanceTo(other, place, ball) / scale;
            model.largest = std::max(model.largest, distance);
            sum += distance;
            ++model.places;
        }
    };
    from(whole, reduced);
    from(reduced, whole);
    model.mean = model.places > 0 ? sum / static_cast<double>(model.places) : 0.0;
}

size_t edgesBeyond(const PerceptualCheck& check, double degrees) {
    return static_cast<size_t>(
        std::ranges::count_if(check.angles, [&](double angle) { return angle > degrees; }));
}

} // namespace

ReducedModel reducedTo(const Scene& scene, const Similarity& workspaceFromScene, double degrees) {
    const auto compiled = [&](const Scene& of) {
        CompileOptions options;
        options.rays = false;
        return compileHapticScene(of, workspaceFromScene, options);
    };
    std::shared_ptr<Scene> now = atRest(scene);
    const auto whole = compiled(*now);
    PerceptualCheck check = checkPerception(*whole, Search::CountAlone);
    if (check.triangles == 0 || check.angles.empty())
        throw Error(scene.path, "", "has no triangles that share a smooth edge", "open a model of triangles");
    if (!(check.most90 <= degrees)) {
        const double finer = check.most90 / degrees;
        throw Error(scene.path, "",
                    "is coarser than that: one smooth edge in ten is beyond " +
                        std::to_string(check.most90).substr(0, 5) + " degrees",
                    "about " +
                        std::to_string(static_cast<size_t>(
                            std::ceil(static_cast<double>(check.triangles) * finer * finer))) +
                        " triangles are needed; ask for a larger angle");
    }
    ReducedModel model{.scene = now,
                       .before = check.triangles,
                       .after = check.triangles,
                       .edgesBeyond = edgesBeyond(check, degrees),
                       .angleBefore = check.most90,
                       .angle = check.most90};
    std::shared_ptr<const HapticScene> best = whole;
    for (;;) {
        now = std::make_shared<Scene>(*now);
        if (!reduce(*now))
            break;
        const auto fewer = compiled(*now);
        check = checkPerception(*fewer, Search::CountAlone);
        // A level may be better than the one before it; none is once all edges are beyond the angle.
        if (check.angles.empty() || check.median > degrees)
            break;
        if (check.most90 > degrees || check.triangles >= model.after)
            continue;
        model.scene = now;
        model.after = check.triangles;
        model.edgesBeyond = edgesBeyond(check, degrees);
        model.angle = check.most90;
        best = fewer;
    }
    if (best != whole)
        measure(*whole, *best, workspaceFromScene.scale, model);
    return model;
}

} // namespace touchstone::study

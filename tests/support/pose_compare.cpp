// What a loaded scene shows against what the specification says it shows.

#include "engine/scene/animation.h"
#include "engine/scene/mesh_deformation.h"
#include "tests/support/pose_truth.h"

#include <algorithm>
#include <limits>

namespace touchstone::test {
namespace {

template <size_t N>
Real distance(const std::array<Real, N>& a, const std::array<Real, N>& b) {
    Real sum = 0;
    for (size_t i = 0; i < N; ++i)
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum);
}

Real sizeOf(const std::vector<TruthObject>& objects) {
    Real3 low, high;
    low.fill(std::numeric_limits<Real>::infinity());
    high.fill(-std::numeric_limits<Real>::infinity());
    for (const TruthObject& object : objects)
        for (const auto& triangle : object.triangles)
            for (const TruthCorner& corner : triangle)
                for (size_t c = 0; c < 3; ++c) {
                    low[c] = std::min(low[c], corner.position[c]);
                    high[c] = std::max(high[c], corner.position[c]);
                }
    return distance(low, high);
}

/// The largest distances over all corners; infinity where the numbers of triangles differ.
PoseDifference difference(const TruthObject& truth, const TruthObject& found) {
    PoseDifference result;
    if (truth.triangles.size() != found.triangles.size()) {
        result.position = std::numeric_limits<Real>::infinity();
        return result;
    }
    for (size_t t = 0; t < truth.triangles.size(); ++t)
        for (size_t k = 0; k < 3; ++k) {
            const TruthCorner &a = truth.triangles[t][k], &b = found.triangles[t][k];
            result.position = std::max(result.position, distance(a.position, b.position));
            result.normal = std::max(result.normal, a.steady * distance(a.normal, b.normal));
            result.uv0 = std::max(result.uv0, distance(a.uv0, b.uv0));
            result.color = std::max(result.color, distance(a.color, b.color));
        }
    return result;
}

} // namespace

Scene sceneAt(const Scene& scene, const Animation* animation, double time) {
    Scene shown = scene;
    ScenePose pose(scene), still(scene);
    pose.evaluate(scene, animation, time);
    for (size_t i = 0; i < shown.instances.size(); ++i)
        shown.instances[i].sceneFromMesh = pose.sceneFromMesh()[i];
    for (Mesh& mesh : shown.meshes) {
        if (mesh.deformation == nullptr)
            continue;
        DeformedVertices vertices(*mesh.deformation), rest(*mesh.deformation);
        vertices.pose(pose);
        rest.pose(still);
        DrawnVertices drawn;
        deform(mesh, vertices, rest, drawn);
        mesh.positions = drawn.positions;
        mesh.normals = drawn.normals;
        mesh.tangents = drawn.tangents;
    }
    return shown;
}

std::vector<TruthObject> objectsOf(const Scene& scene) {
    std::vector<TruthObject> objects;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        Affine place{};
        for (size_t r = 0; r < 3; ++r)
            for (size_t c = 0; c < 4; ++c)
                place[r][c] = instance.sceneFromMesh[static_cast<int>(c)][static_cast<int>(r)];
        TruthObject object;
        object.place = mesh.name;
        for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            std::array<TruthCorner, 3> triangle;
            for (size_t k = 0; k < 3; ++k) {
                const uint32_t v = mesh.indices[i + k];
                const glm::vec3 &p = mesh.positions[v], &n = mesh.normals[v];
                triangle[k].position = point(place, {p.x, p.y, p.z});
                triangle[k].normal = normalUnder(place, {n.x, n.y, n.z});
                if (!mesh.uv0.empty())
                    triangle[k].uv0 = {mesh.uv0[v].x, mesh.uv0[v].y};
                if (!mesh.colors.empty())
                    triangle[k].color = {mesh.colors[v].x, mesh.colors[v].y, mesh.colors[v].z,
                                         mesh.colors[v].w};
            }
            if (determinant(place) < 0)
                std::swap(triangle[1], triangle[2]);
            object.triangles.push_back(triangle);
        }
        objects.push_back(std::move(object));
    }
    return objects;
}

PoseDifference compare(const std::vector<TruthObject>& truth, const std::vector<TruthObject>& found) {
    PoseDifference result;
    result.size = sizeOf(truth);
    if (truth.size() != found.size()) {
        result.problem =
            std::to_string(found.size()) + " objects where there should be " + std::to_string(truth.size());
        return result;
    }
    std::vector<bool> taken(found.size(), false);
    for (const TruthObject& object : truth) {
        size_t nearest = 0;
        PoseDifference least;
        least.position = std::numeric_limits<Real>::infinity();
        for (size_t f = 0; f < found.size(); ++f) {
            const PoseDifference here = taken[f] ? least : difference(object, found[f]);
            if (here.position < least.position) {
                least = here;
                nearest = f;
            }
        }
        if (std::isinf(least.position)) {
            result.problem = "nothing has the " + std::to_string(object.triangles.size()) + " triangles of " +
                             object.place;
            return result;
        }
        taken[nearest] = true;
        if (least.position > result.position * result.size)
            result.worst = object.place;
        result.position = std::max(result.position, least.position / result.size);
        result.normal = std::max(result.normal, least.normal);
        result.uv0 = std::max(result.uv0, least.uv0);
        result.color = std::max(result.color, least.color);
    }
    return result;
}

} // namespace touchstone::test

#include "devices/surface/triangle_source.h"

#include "engine/scene/scene.h"

#include <array>
#include <limits>

namespace touchstone {

namespace {

/// The vertices of one instance in the device frame. Neighbouring triangles share vertices, and a transform
/// in double costs more than the rest of the work per triangle: the latest are cached.
class PlacedVertices {
  public:
    PlacedVertices(const Mesh& mesh, const glm::dmat4& sceneFromMesh, const Similarity& deviceFromScene)
        : mesh_(mesh), sceneFromMesh_(sceneFromMesh), deviceFromScene_(deviceFromScene) {
        kept_.fill(std::numeric_limits<uint32_t>::max());
    }
    const glm::dvec3& at(uint32_t index) {
        const size_t slot = index % kSlots;
        if (kept_[slot] != index) {
            const glm::dvec4 local(glm::dvec3(mesh_.positions[index]), 1.0);
            placed_[slot] = deviceFromScene_.point(glm::dvec3(sceneFromMesh_ * local));
            kept_[slot] = index;
        }
        return placed_[slot];
    }

  private:
    static constexpr size_t kSlots = 4096; // 112 KiB
    const Mesh& mesh_;
    const glm::dmat4& sceneFromMesh_;
    const Similarity& deviceFromScene_;
    std::array<uint32_t, kSlots> kept_;
    std::array<glm::dvec3, kSlots> placed_;
};

} // namespace

TriangleSource trianglesOf(const Scene& scene, const Similarity& deviceFromScene) {
    return [&scene, deviceFromScene](const TriangleVisitor& visit) {
        SurfaceTriangle triangle;
        for (const Instance& instance : scene.instances) {
            const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
            triangle.front = 0;
            if (!scene.materials.empty() &&
                scene.materials[static_cast<size_t>(mesh.material)].haptic.sides == SideChoice::Front)
                triangle.front = glm::determinant(glm::dmat3(instance.sceneFromMesh)) < 0.0 ? -1 : 1;
            PlacedVertices placed(mesh, instance.sceneFromMesh, deviceFromScene);
            for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
                triangle.a = placed.at(mesh.indices[i]);
                triangle.b = placed.at(mesh.indices[i + 1]);
                triangle.c = placed.at(mesh.indices[i + 2]);
                visit(triangle);
            }
            ++triangle.object;
        }
    };
}

TriangleSource trianglesOf(std::span<const glm::dvec3> corners) {
    return [corners](const TriangleVisitor& visit) {
        for (size_t i = 0; i + 2 < corners.size(); i += 3)
            visit({corners[i], corners[i + 1], corners[i + 2]});
    };
}

TriangleSource trianglesOf(std::span<const SurfaceTriangle> triangles) {
    return [triangles](const TriangleVisitor& visit) {
        for (const SurfaceTriangle& triangle : triangles)
            visit(triangle);
    };
}

Bounds boundsOf(const TriangleSource& triangles) {
    Bounds bounds;
    triangles([&](const SurfaceTriangle& t) {
        bounds.include(t.a);
        bounds.include(t.b);
        bounds.include(t.c);
    });
    return bounds;
}

std::vector<SurfaceTriangle> trianglesNear(const TriangleSource& triangles, const glm::dvec3& centre,
                                           double half) {
    std::vector<SurfaceTriangle> near;
    const glm::dvec3 low = centre - half, high = centre + half;
    triangles([&](const SurfaceTriangle& t) {
        const glm::dvec3 least = glm::min(t.a, glm::min(t.b, t.c)), most = glm::max(t.a, glm::max(t.b, t.c));
        if (glm::all(glm::lessThanEqual(least, high)) && glm::all(glm::greaterThanEqual(most, low)))
            near.push_back(t);
    });
    return near;
}

} // namespace touchstone

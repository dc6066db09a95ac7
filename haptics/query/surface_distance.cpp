#include "haptics/query/surface_distance.h"

#include "haptics/scene/haptic_scene.h"
#include "haptics/shape/mesh/embree.h"
#include "haptics/shape/mesh/triangle.h"
#include "haptics/shape/near_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace touchstone {

namespace {

/// Boxes of a deforming mesh that are looked at before all of its triangles are.
constexpr size_t kManyNear = 4096;

struct Nearest {
    const HapticObject* object;
    glm::dvec3 point;
    double distance;
};

bool visit(RTCPointQueryFunctionArguments* arguments) {
    auto& nearest = *static_cast<Nearest*>(arguments->userPtr);
    const HapticObject& object = *nearest.object;
    const auto corner = [&](size_t k) {
        return glm::dvec3(object.vertices[object.indices[3 * arguments->primID + k]]);
    };
    const double distance = distanceTo(Triangle(corner(0), corner(1), corner(2)), nearest.point).distance;
    if (distance >= nearest.distance)
        return false;
    nearest.distance = distance;
    return false; // the ball keeps its radius: rounding might cut off the nearest triangle
}

} // namespace

double surfaceDistance(const HapticScene& scene, ObjectMotions motions, const glm::dvec3& point,
                       double within) {
    const auto moves = [](const auto& object) { return object->instant != nullptr; };
    if (!std::ranges::all_of(scene.objects, moves))
        scene.buildRays();
    if (motions.empty())
        motions = scene.restMotions;
    for (size_t k = 0; k < scene.objects.size(); ++k) {
        const double start = within / motions[k].workspaceFromObject.scale;
        Nearest nearest{scene.objects[k].get(), motions[k].workspaceFromObject.inversePoint(point), start};
        if (const Shape* shape = scene.objects[k]->shape.get()) {
            std::array<FeatureDistance, NearShapes::kMaxFeatures> found;
            const size_t count = shape->near(nearest.point, start, found);
            for (const FeatureDistance& d : std::span(found).first(count))
                within = std::min(within, std::abs(d.distance) * motions[k].workspaceFromObject.scale);
            continue;
        }
        if (scene.objects[k]->instant != nullptr) {
            const HapticObject& object = *scene.objects[k];
            const auto to = [&](uint32_t triangle) {
                return distanceTo(triangleOf(object, triangle), nearest.point).distance;
            };
            std::vector<TriangleTree::Near> near(kManyNear);
            const size_t count = treeOf(object).collect(
                glm::vec3(nearest.point),
                static_cast<float>(start + 4e-7 * (1.0 + glm::length(nearest.point))), near);
            if (count < near.size())
                for (const TriangleTree::Near& box : std::span(near).first(count))
                    nearest.distance = std::min(nearest.distance, to(box.triangle));
            else
                for (uint32_t t = 0; t < object.triangleCount(); ++t)
                    nearest.distance = std::min(nearest.distance, to(t));
            within = std::min(within, nearest.distance * motions[k].workspaceFromObject.scale);
            continue;
        }
        // Embree rounds to float: a slightly larger ball loses nothing, the double distance decides.
        RTCPointQuery query{};
        query.x = static_cast<float>(nearest.point.x);
        query.y = static_cast<float>(nearest.point.y);
        query.z = static_cast<float>(nearest.point.z);
        query.radius = static_cast<float>(start + 4e-7 * (1.0 + glm::length(nearest.point)));
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        rtcPointQuery(scene.objects[k]->rays.get(), &query, &context, visit, &nearest);
        if (nearest.distance < start)
            within = nearest.distance * motions[k].workspaceFromObject.scale;
    }
    return within;
}

} // namespace touchstone

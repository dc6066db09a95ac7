#include "haptics/proxy/clear_of_model.h"

#include "haptics/contact/ray.h"
#include "haptics/contact/triangle.h"

#include <embree3/rtcore.h>

#include <array>

namespace touchstone {

namespace {

constexpr size_t kAxes = 7; // each looked along in both directions
constexpr int kEnclosing = 10;

/// The axes and diagonals of a cube that is turned, so that no ray runs along a facet of a box.
constexpr std::array<glm::dvec3, kAxes> kDirections{{{0.8138, 0.4698, 0.3420},
                                                     {-0.5438, 0.8232, 0.1632},
                                                     {-0.2049, -0.3188, 0.9254},
                                                     {0.0376, 0.5625, 0.8260},
                                                     {0.6655, -0.3881, 0.6375},
                                                     {-0.9021, 0.0200, 0.4310},
                                                     {-0.2742, -0.9306, 0.2426}}};

struct NearSearch {
    const HapticObject* object;
    glm::dvec3 point;
    double reach; ///< object units
    bool found = false;
};

bool visit(RTCPointQueryFunctionArguments* arguments) {
    auto& search = *static_cast<NearSearch*>(arguments->userPtr);
    if (search.found ||
        distanceTo(triangleOf(*search.object, arguments->primID), search.point).distance >= search.reach)
        return false;
    search.found = true;
    arguments->query->radius = 0.0f; // one is enough
    return true;
}

bool isNear(const HapticObject& object, const Similarity& pose, const glm::dvec3& hip) noexcept {
    NearSearch search{&object, pose.inversePoint(hip), kModelReach / pose.scale};
    if (glm::length(search.point) > object.boundingRadius + search.reach)
        return false;
    RTCPointQuery query{};
    query.x = static_cast<float>(search.point.x);
    query.y = static_cast<float>(search.point.y);
    query.z = static_cast<float>(search.point.z);
    query.radius = static_cast<float>(search.reach);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(object.bvh.get(), &query, &context, visit, &search);
    return search.found;
}

/// A surface with both sides that the ray from `hip` along the unit vector `direction` meets.
bool isBarred(const HapticScene& scene, ObjectMotions motions, const glm::dvec3& hip,
              const glm::dvec3& direction) noexcept {
    for (size_t k = 0; k < scene.objects.size(); ++k) {
        const HapticObject& object = *scene.objects[k];
        if (object.oneSided)
            continue;
        const Similarity& pose = motions[k].workspaceFromObject;
        const glm::dvec3 from = pose.inversePoint(hip);
        const glm::dvec3 along = glm::conjugate(pose.rotation) * direction;
        const double ahead = -glm::dot(from, along), square = glm::dot(from, from),
                     radius = object.boundingRadius;
        if (square > radius * radius && (ahead < 0.0 || square - ahead * ahead > radius * radius))
            continue;
        if (castRay(object, glm::vec3(from), glm::vec3(along), 0.0f,
                    static_cast<float>(ahead + radius + 1e-3)))
            return true;
    }
    return false;
}

bool isEnclosed(const HapticScene& scene, ObjectMotions motions, const glm::dvec3& hip) noexcept {
    int barred = 0, left = 2 * static_cast<int>(kAxes);
    for (const glm::dvec3& direction : kDirections)
        for (const double sign : {1.0, -1.0}) {
            barred += isBarred(scene, motions, hip, sign * direction) ? 1 : 0;
            if (barred >= kEnclosing)
                return true;
            if (barred + --left < kEnclosing)
                return false;
        }
    return false;
}

} // namespace

bool clearOfModel(const HapticScene& scene, ObjectMotions motions, const glm::dvec3& hip) noexcept {
    for (size_t k = 0; k < scene.objects.size(); ++k)
        if (isNear(*scene.objects[k], motions[k].workspaceFromObject, hip))
            return false;
    return !isEnclosed(scene, motions, hip);
}

} // namespace touchstone

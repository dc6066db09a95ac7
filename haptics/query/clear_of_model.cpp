#include "haptics/query/clear_of_model.h"

#include "haptics/shape/mesh/ray_walk.h"
#include "haptics/shape/mesh/triangle.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace touchstone {

namespace {

constexpr size_t kAxes = 7; // each tested in both directions
constexpr int kEnclosing = 10;

/// The axes and diagonals of a rotated cube, so that no ray runs along a facet of a box.
constexpr std::array<glm::dvec3, kAxes> kDirections{{{0.8138, 0.4698, 0.3420},
                                                     {-0.5438, 0.8232, 0.1632},
                                                     {-0.2049, -0.3188, 0.9254},
                                                     {0.0376, 0.5625, 0.8260},
                                                     {0.6655, -0.3881, 0.6375},
                                                     {-0.9021, 0.0200, 0.4310},
                                                     {-0.2742, -0.9306, 0.2426}}};

/// Maximum number of boxes tested against the ball around a hand; with more, the surface counts as near.
constexpr size_t kLookedAt = 512;

bool isNear(const HapticObject& object, const Similarity& pose, const glm::dvec3& hip) noexcept {
    const glm::dvec3 point = pose.inversePoint(hip);
    const double reach = kModelReach / pose.scale;
    if (glm::length(point) > object.boundingRadius + reach)
        return false;
    if (object.shape != nullptr) {
        std::array<FeatureDistance, 1> any;
        return object.shape->near(point, reach, any) > 0;
    }
    std::array<TriangleTree::Near, kLookedAt> boxes;
    const size_t count = treeOf(object).collect(glm::vec3(point), static_cast<float>(reach), boxes);
    if (count == boxes.size())
        return true;
    return std::any_of(boxes.begin(), boxes.begin() + static_cast<std::ptrdiff_t>(count),
                       [&](const TriangleTree::Near& box) {
                           return distanceTo(triangleOf(object, box.triangle), point).distance < reach;
                       });
}

/// The query of firstCrossing for a shape: a ball of radius zero swept past all of it.
bool meets(const HapticObject& object, const glm::dvec3& from, const glm::dvec3& along) noexcept {
    const double far = glm::length(from) + object.boundingRadius;
    return object.shape->sweep(from, 0.0, far * along, 1.0) < 1.0;
}

/// True where the ray from `hip` along the unit vector `direction` meets a two-sided surface. `objectAt`: of
/// each number.
template <class ObjectAt>
bool isBarred(const ObjectAt& objectAt, ObjectMotions motions, const glm::dvec3& hip,
              const glm::dvec3& direction) noexcept {
    for (size_t k = 0; k < motions.size(); ++k) {
        const HapticObject& object = objectAt(k);
        if (object.oneSided)
            continue;
        const Similarity& pose = motions[k].workspaceFromObject;
        const glm::dvec3 from = pose.inversePoint(hip);
        const glm::dvec3 along = glm::conjugate(pose.rotation) * direction;
        if (object.shape != nullptr ? meets(object, from, along)
                                    : firstCrossing(object, from, along, false).has_value())
            return true;
    }
    return false;
}

template <class ObjectAt>
bool isEnclosedBy(const ObjectAt& objectAt, ObjectMotions motions, const glm::dvec3& hip) noexcept {
    int barred = 0, left = 2 * static_cast<int>(kAxes);
    for (const glm::dvec3& direction : kDirections)
        for (const double sign : {1.0, -1.0}) {
            barred += isBarred(objectAt, motions, hip, sign * direction) ? 1 : 0;
            if (barred >= kEnclosing)
                return true;
            if (barred + --left < kEnclosing)
                return false;
        }
    return false;
}

} // namespace

bool isEnclosed(const HapticScene& scene, ObjectMotions motions, const glm::dvec3& hip) noexcept {
    return isEnclosedBy([&](size_t k) -> const HapticObject& { return *scene.objects[k]; }, motions, hip);
}

bool isEnclosedIn(const HapticScene& part, const HapticScene& scene, const HapticScene& now,
                  ObjectMotions motions, const glm::dvec3& hip) noexcept {
    return isEnclosedBy(
        [&](size_t k) -> const HapticObject& {
            return part.objects[k] == scene.objects[k] ? *now.objects[k] : *part.objects[k];
        },
        motions, hip);
}

bool clearOfModel(const HapticScene& scene, ObjectMotions motions, const glm::dvec3& hip) noexcept {
    for (size_t k = 0; k < scene.objects.size(); ++k)
        if (isNear(*scene.objects[k], motions[k].workspaceFromObject, hip))
            return false;
    return !isEnclosed(scene, motions, hip);
}

} // namespace touchstone

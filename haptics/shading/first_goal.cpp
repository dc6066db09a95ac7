#include "haptics/shading/first_goal.h"

#include "haptics/shading/shading_mode.h"
#include "haptics/shading/tilt_limit.h"

#include <array>
#include <cmath>
#include <optional>

namespace touchstone {

namespace {

/// A facet with its field of interpolated normals, as a linear function of the place: N(x) = atA + (x - a) .
/// overB * towardsB + (x - a) . overC * towardsC, not of unit length.
struct SmoothFacet {
    glm::dvec3 a, normal;
    glm::dvec3 atA, towardsB, towardsC; ///< normal of corner a; those of b and c relative to it
    glm::dvec3 overB, overC;            ///< gradients of the corners' barycentric weights

    SmoothFacet(const HapticObject& object, uint32_t triangle) {
        const size_t first = 3 * static_cast<size_t>(triangle);
        std::array<glm::dvec3, 3> corners, normals; // read first: what follows is one piece of arithmetic
        for (size_t k = 0; k < 3; ++k) {
            corners[k] = vertexOf(object, object.indices[first + k]);
            normals[k] = normalOf(object, object.sourceIndices[first + k]);
        }
        const auto normalAt = [&](size_t k) { return normals[k]; };
        a = corners[0];
        const glm::dvec3 b = corners[1] - a, c = corners[2] - a, area = glm::cross(b, c);
        const double squared = glm::dot(area, area);
        normal = area / std::sqrt(squared);
        atA = normalAt(0);
        towardsB = normalAt(1) - atA;
        towardsC = normalAt(2) - atA;
        overB = glm::cross(c, area) / squared;
        overC = glm::cross(area, b) / squared;
    }

    /// `fromA`: position relative to corner a.
    [[nodiscard]] glm::dvec3 normalAt(const glm::dvec3& fromA) const {
        return atA + glm::dot(overB, fromA) * towardsB + glm::dot(overC, fromA) * towardsC;
    }
    [[nodiscard]] bool contains(const glm::dvec3& fromA) const {
        const double b = glm::dot(overB, fromA), c = glm::dot(overC, fromA);
        return b > 0.0 && c > 0.0 && b + c < 1.0;
    }
};

/// The fixed point of goal -> proxy -> interpolated plane -> goal for a proxy that slides on the plane of one
/// facet, without a query of the mesh: each round of shading takes a move, here it takes a square root. Empty
/// where the facet does not hold the proxy, the normals tilt beyond the limit, or the iteration does not
/// converge (a hollow pressed deeper than it is wide).
std::optional<FirstGoal> goalOnFacet(const HapticObject& object, const HapticSettings& settings,
                                     const DeviceState& state, const glm::dvec3& hip,
                                     const glm::dvec3& guess) {
    constexpr int kMaxSteps = 6;
    constexpr double kStill = 1e-8; // object units; the remaining error is a few hundredths of it
    const SmoothFacet facet(object, state.shadedTriangle);
    glm::dvec3 place = state.proxy - facet.a, up = facet.normal;
    if (!facet.contains(place))
        return {};
    double height = glm::dot(place, up);
    if (height < 0.0) { // from the back
        height = -height;
        up = -up;
    }
    const double outwards = glm::dot(facet.normalAt(place), up) < 0.0 ? -1.0 : 1.0;
    const glm::dvec3 hand = hip - facet.a;
    place = hand + glm::dot(guess, place - hand) * guess;
    place -= (glm::dot(place, up) - height) * up;
    for (int step = 0; step < kMaxSteps; ++step) {
        const glm::dvec3 field = outwards * facet.normalAt(place);
        const double squared = glm::dot(field, field), cosine = glm::dot(field, up);
        const double depth = glm::dot(field, place - hand);
        const double length = std::sqrt(squared);
        if (!(depth > 0.0) || leansBeyond(cosine / length, settings.shadingTiltLimit))
            return {};
        const glm::dvec3 goal = hand + depth / squared * field;
        const double above = glm::dot(goal, up) - height;
        const glm::dvec3 onPlane = goal - above * up;
        const glm::dvec3 change = onPlane - place;
        place = onPlane;
        if (glm::dot(change, change) > kStill * kStill)
            continue;
        // Beyond the facet's edge another plane holds the proxy, and a start from this goal costs one more
        // move.
        if (!facet.contains(place))
            return {};
        return FirstGoal{.goal = facet.a + (above > 0.0 ? onPlane : goal),
                         .onFacet = true,
                         .place = facet.a + place,
                         .normal = field / length};
    }
    return {};
}

} // namespace

FirstGoal firstGoal(const HapticScene& scene, const HapticSettings& settings, const DeviceState& state,
                    const glm::dvec3& hip, double travel) noexcept {
    if (!state.shaded)
        return {.goal = hip};
    const glm::dvec3 normal = travel > 0.0 ? state.shadedNormal + state.shadedTurn : state.shadedNormal;
    if (state.shadedObject == state.reference) {
        const HapticObject& object = *scene.objects[static_cast<size_t>(state.reference)];
        const HapticMaterialData& material = scene.materials[static_cast<size_t>(object.material)];
        // A checkpoint may name any facet, including one of an object without normals. A flat facet may have
        // held the proxy beside a smooth one.
        if (shadingMode(settings, material) == ShadingMode::TwoPass && !object.normals.empty() &&
            object.smooth[state.shadedTriangle] != 0)
            if (const auto goal = goalOnFacet(object, settings, state, hip, normal))
                return *goal;
    }
    // The goal stays below the shaded plane by as much as that plane can rise over the true one in this tick,
    // so that the proxy is not lifted off before it is shaded.
    constexpr double kRise = 0.2;
    const glm::dvec3 unit = glm::normalize(normal);
    const double depth = glm::dot(state.proxy - hip, unit) - kRise * travel;
    return {.goal = depth > 0.0 ? hip + depth * unit : hip};
}

} // namespace touchstone

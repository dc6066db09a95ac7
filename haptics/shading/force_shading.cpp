#include "haptics/shading/force_shading.h"

#include "haptics/contact/triangle.h"
#include "haptics/tick_flags.h"

#include <array>
#include <cmath>

namespace touchstone {

namespace {

/// The goal contracts by depth over radius of curvature each time (0.04 on a 25 mm torus pressed 1 mm, 0.15
/// on the ten-sided prism of [000 Fig. 6]); twelve rounds take the worst of these below a nanometre.
constexpr int kMaxRounds = 12;
/// Object units: 1.5 nm on a fitted model, 1.5 µN at 1000 N/m.
constexpr double kGoalTolerance = 1e-8;

} // namespace

glm::dvec3 interpolatedNormal(const HapticScene& scene, ObjectMotions motions, int anchor,
                              const Contact& contact, double tiltLimit) noexcept {
    const auto k = static_cast<size_t>(contact.object);
    const HapticObject& object = *scene.objects[k];
    if (object.smooth[contact.triangle] == 0 ||
        !scene.materials[static_cast<size_t>(object.material)].shading)
        return contact.normal;
    glm::dvec3 point = contact.point, trueNormal = contact.normal;
    Similarity anchorFromObject;
    const bool foreign = contact.object != anchor;
    if (foreign) {
        anchorFromObject = motions[static_cast<size_t>(anchor)].workspaceFromObject.inverse() *
                           motions[k].workspaceFromObject;
        const Similarity back = anchorFromObject.inverse();
        point = back.point(point);
        trueNormal = back.direction(trueNormal);
    }
    const size_t first = 3 * static_cast<size_t>(contact.triangle);
    const Triangle triangle(glm::dvec3(object.vertices[object.indices[first]]),
                            glm::dvec3(object.vertices[object.indices[first + 1]]),
                            glm::dvec3(object.vertices[object.indices[first + 2]]));
    const glm::dvec3 weight = barycentric(triangle, point);
    glm::dvec3 normal = weight.x * glm::dvec3(object.normals[object.sourceIndices[first]]) +
                        weight.y * glm::dvec3(object.normals[object.sourceIndices[first + 1]]) +
                        weight.z * glm::dvec3(object.normals[object.sourceIndices[first + 2]]);
    const double length = glm::length(normal);
    if (!(length > 1e-6))
        return contact.normal; // opposed vertex normals cancel: no shading to be had
    normal /= length;
    // The model's normals show outwards; a proxy on the back of a sheet feels the same curve from below.
    double cosine = glm::dot(normal, trueNormal);
    if (cosine < 0.0) {
        normal = -normal;
        cosine = -cosine;
    }
    const double limit = std::cos(tiltLimit);
    if (cosine < limit) {
        const glm::dvec3 sideways = normal - cosine * trueNormal;
        const double sine = glm::length(sideways);
        normal = sine > 0.0 ? limit * trueNormal + std::sin(tiltLimit) / sine * sideways : trueNormal;
    }
    return foreign ? anchorFromObject.direction(normal) : normal;
}

glm::dvec3 warmGoal(const DeviceState& state, const glm::dvec3& hip) noexcept {
    if (!state.shaded)
        return hip;
    const double depth = glm::dot(state.proxy - hip, state.shadedNormal);
    return depth > 0.0 ? hip + depth * state.shadedNormal : hip;
}

void shadeTwoPass(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                  const glm::dvec3& hip, const glm::dvec3& firstGoal, MeshProxy& proxy, DeviceState& state,
                  ProxyRest& rest) noexcept {
    glm::dvec3 lastGoal = firstGoal;
    std::array<ConstraintPlane, ProxyRest::kMaxContacts> planes;
    for (int round = 0; round < kMaxRounds; ++round) {
        bool anyTilted = false;
        for (uint32_t i = 0; i < rest.contactCount; ++i) {
            planes[i] = {
                interpolatedNormal(scene, motions, state.anchor, rest.contacts[i], settings.shadingTiltLimit),
                0.0};
            anyTilted |= planes[i].normal != rest.contacts[i].normal;
        }
        state.shaded = anyTilted;
        if (!anyTilted && lastGoal == hip)
            return;
        const SubGoal pass = nearestFeasible(hip - state.proxy, {planes.data(), rest.contactCount});
        if (anyTilted && pass.count > 0) {
            const glm::dvec3 towards = pass.point - (hip - state.proxy);
            const double length = glm::length(towards);
            state.shaded = length > 0.0;
            if (state.shaded)
                state.shadedNormal = towards / length;
        } else {
            state.shaded = false;
        }
        glm::dvec3 goal = state.proxy + pass.point;
        if (pass.count > 0 && rest.contactCount > 0) {
            // A goal above all true planes would lift the proxy off: back onto the nearest of them [000 §4].
            double nearest = INFINITY;
            glm::dvec3 normal(0.0);
            for (uint32_t i = 0; i < rest.contactCount; ++i) {
                const double above =
                    glm::dot(rest.contacts[i].normal, pass.point) - (kContactGap - rest.contacts[i].gap);
                if (above < nearest) {
                    nearest = above;
                    normal = rest.contacts[i].normal;
                }
            }
            if (nearest > 0.0)
                goal -= nearest * normal;
        }
        if (glm::length(goal - lastGoal) <= kGoalTolerance)
            return;
        proxy.moveTowards(goal);
        lastGoal = goal;
    }
    rest.flags = rest.flags | TickFlag::ShadingNotConverged;
}

} // namespace touchstone

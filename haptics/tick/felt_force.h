#pragma once
// Stages 5 to 7 of a tick, and the part of stage 4 that turns only the force: from the solve result to a
// force. Only haptic_step.cpp includes this file. Functions that a scene may not need are out of line, so
// that they take no registers from those that every scene needs; what every tick needs is in line in both
// instances of feltForce, since the compiler shares it between them otherwise (62 instructions a function).

#include "haptics/comparison/comparison_solver.h"
#include "haptics/force/contact_loads.h"
#include "haptics/force/spring_damper.h"
#include "haptics/friction/friction.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/shading/force_shading.h"
#include "haptics/shading/turned_normal.h"
#include "haptics/surface/plain_sample.h"
#include "haptics/surface/surface_sample.h"
#include "haptics/tick/hand_tick.h"
#include "haptics/tick/haptic_step.h"

#include <type_traits>
#include <variant>

namespace touchstone {

/// The felt shape at the final proxy: the direction of the force and the depth of the HIP, for each shading
/// model.
struct FeltShape {
    glm::dvec3 normal{0.0}; ///< unit, reference object frame
    double depth = 0.0;     ///< reference object units
};

/// The felt shape where one facet's force is turned.
[[gnu::noinline]] FeltShape turnedShape(const HandTick& tick, int reference, const Contact& facet,
                                        const glm::dvec3& offset, const FeltShape& shape);

/// The felt shape where all contacts are felt as one. `oneFacet`: some surface of the scene turns the force
/// of its facet.
[[gnu::always_inline]] inline FeltShape feltShape(const HandTick& tick, bool oneFacet, const glm::dvec3& hip,
                                                  const DeviceState& state, const SubGoal& activeSet) {
    const glm::dvec3 offset = state.proxy - hip;
    const double depth = glm::length(offset);
    const Contact& holder =
        state.rest.contacts[activeSet.count > 0 ? static_cast<size_t>(activeSet.active[0]) : 0];
    const FeltShape shape{depth > 100.0 * kContactGap ? offset / depth : holder.normal, depth};
    if (oneFacet && activeSet.count == 1)
        return turnedShape(tick, state.reference, holder, offset, shape);
    return shape;
}

/// Velocity of the HIP relative to the reference object's surface, m/s, in the reference object frame.
[[gnu::always_inline]] inline glm::dvec3 surfaceVelocity(const HandTick& tick, const DeviceState& state) {
    const ObjectMotion& reference = tick.motions[static_cast<size_t>(state.reference)];
    const Similarity& now = reference.workspaceFromObject;
    glm::dvec3 carried(0.0);
    if (tick.moving && !reference.jumped)
        carried = (now.point(state.proxy) - reference.before.point(state.proxy)) / tick.dt;
    return glm::conjugate(now.rotation) * (state.velocity - carried);
}

/// Stage 5 where the touched material needs it. `velocity` of the HIP relative to the surface.
[[gnu::noinline]] void feelTexture(const HandTick& tick, DeviceState& state, const Contact& contact,
                                   const glm::dvec3& normal, double depth, const glm::dvec3& velocity,
                                   SurfaceSample& feel, HapticOutput& output);

/// Stages 5 and 7 without friction, where several contacts are felt separately.
struct SeveralContacts {
    glm::dvec3 force{0.0}; ///< elastic and damping, N, reference object frame
    FrictionCone cone;
};

/// `feel` becomes the sample of the contact with the largest load, with the direction of the whole elastic
/// force. `velocity` of the HIP relative to the surface; the zoom is already divided out of the force, which
/// the device can bear.
[[gnu::noinline]] void feelSeveral(const HandTick& tick, DeviceState& state, const SubGoal& activeSet,
                                   const glm::dvec3& offset, double workspacePerReference,
                                   const glm::dvec3& velocity, SurfaceSample& feel, SeveralContacts& several,
                                   HapticOutput& output);

/// The elastic force of each contact where all are felt as one: `stiffness` (N/m) times lambda_i n_i. Fills
/// tick.parts.
[[gnu::noinline]] void splitPlain(const HandTick& tick, const DeviceState& state, const SubGoal& activeSet,
                                  double stiffness, double workspacePerReference);

/// True where the planes need not be distinguished: all have one plain material without damping whose force
/// nothing turns, so that the force is K (p - h) whatever the loads; or no plane carries a load (RayProxy
/// between planes that leave it no room).
bool feltAsOne(const HandTick& tick, bool oneFacet, const SolveResult& rest, const SubGoal& activeSet);

/// Publishes the contacts that hold the HIP off, before friction moves the proxy.
[[gnu::always_inline]] inline void publishContact(const Similarity& workspaceFromReference,
                                                  const SolveResult& rest, const SurfaceSample& feel,
                                                  HapticOutput& output) {
    output.contacts = rest.contactCount;
    if (!feel.touching)
        return;
    output.object = feel.object;
    output.triangle = static_cast<int>(feel.triangle);
    output.normal = workspaceFromReference.direction(feel.textured);
    output.height = feel.height - feel.dent;
    output.planeCount = static_cast<uint32_t>(rest.activeSet.count);
    for (size_t i = 0; i < output.planeCount; ++i)
        output.planes[i] = workspaceFromReference.direction(
            rest.contacts[static_cast<size_t>(rest.activeSet.active[i])].normal);
}

/// Result of stages 5 to 7.
struct Felt {
    glm::dvec3 force{0.0};  ///< N, reference object frame
    double share = 1.0;     ///< fraction of it that the device bears; at most 1
    int object = -1;        ///< HapticScene::objects; -1: nothing is touched
    double stiffness = 0.0; ///< N/m, of the contact with the largest load
};

/// Stages 5 to 7, and the part of stage 4 that turns only the force. `held`: proxy at the start of the tick;
/// `hip`: reference object frame. Effects: some material of the scene needs more than a constant stiffness
/// and damping, or several contacts are felt separately.
template <bool Effects, class Solver, class Stopwatch>
Felt feltForce(const HandTick& tick, const glm::dvec3& hip, const glm::dvec3& held, const SubGoal& activeSet,
               Solver& proxy, DeviceState& state, HapticOutput& output, Stopwatch& stopwatch) {
    const HapticScene& scene = tick.scene;
    const HapticSettings& settings = tick.settings;
    SolveResult& rest = state.rest;
    const Similarity& workspaceFromReference =
        tick.motions[static_cast<size_t>(state.reference)].workspaceFromObject;
    const bool oneFacet = Effects && Solver::shades(settings) && anyOneFacet(scene.plan, settings);
    const bool asOne = !Effects || activeSet.count <= 1 || feltAsOne(tick, oneFacet, rest, activeSet);
    FeltShape shape;
    if (rest.contactCount > 0 && asOne)
        shape = feltShape(tick, oneFacet, hip, state, activeSet);
    stopwatch.lap(Stage::Shading);

    // 5. Surface: material, attributes and maps at each contact.
    glm::dvec3 velocity = surfaceVelocity(tick, state);
    SurfaceSample feel;
    [[maybe_unused]] std::conditional_t<Effects, SeveralContacts, std::monostate> several;
    bool plain = true;
    if (rest.contactCount > 0) {
        const Contact& contact = loadedContact(rest, activeSet);
        const double depth = shape.depth * workspaceFromReference.scale;
        plain = !Effects || (asOne && feelsPlain(materialOf(scene, contact), settings));
        if (plain)
            plainSample(scene, settings, tick.limits, contact, shape.normal, depth, feel);
        else if (asOne)
            feelTexture(tick, state, contact, shape.normal, depth, velocity, feel, output);
        else if constexpr (Effects)
            feelSeveral(tick, state, activeSet, state.proxy - hip, workspaceFromReference.scale, velocity,
                        feel, several, output);
        if (asOne && tick.parts != nullptr) [[unlikely]]
            splitPlain(tick, state, activeSet, feel.stiffness, workspaceFromReference.scale);
    }
    if (feel.tiltCompressed)
        output.flags = output.flags | TickFlag::TiltCompressed;
    publishContact(workspaceFromReference, rest, feel, output);
    if (output.zoom > 1.0)
        velocity /= output.zoom;
    stopwatch.lap(Stage::Texture);

    // 6. Friction: holds the proxy back inside the cones.
    [[maybe_unused]] glm::dvec3 stretch(0.0);
    if constexpr (!Effects) {
        state.friction = FrictionState::Free;
    } else if (!plain || state.friction != FrictionState::Free) {
        if (asOne)
            several.cone = FrictionCone(feel, velocity, workspaceFromReference.scale);
        stretch = workspaceFromReference.scale *
                  applyFriction(settings, several.cone, velocity, tick.dt, held, proxy, state, rest);
    }
    stopwatch.lap(Stage::Friction);

    proxy.settleClearance();

    // 7. Force.
    glm::dvec3 force;
    if (plain)
        force = plainForce(feel, velocity);
    else if constexpr (Effects)
        force = asOne ? springDamperForce(feel, stretch, several.cone.viscousForce(), velocity)
                      : several.force + several.cone.stiffness() * stretch + several.cone.viscousForce();
    if constexpr (std::is_same_v<Solver, ComparisonSolver>) {
        glm::dvec3 viscous(0.0);
        if constexpr (Effects)
            viscous = several.cone.viscousForce();
        if (feel.touching)
            force = proxy.asPublished(force, hip, workspaceFromReference.scale, feel.stiffness, feel.damping,
                                      velocity, viscous);
    }
    const double share =
        output.zoom > 1.0 && asOne ? bearableShare(feel.stiffness, output.zoom, settings, tick.limits) : 1.0;
    return {force, share, feel.touching ? feel.object : -1, feel.stiffness};
}

} // namespace touchstone

#include "haptics/tick/haptic_step.h"

#include "haptics/comparison/comparison_solver.h"
#include "haptics/force/contact_loads.h"
#include "haptics/force/spring_damper.h"
#include "haptics/friction/friction.h"
#include "haptics/proxy/place_proxy.h"
#include "haptics/proxy/proxy_solver.h"
#include "haptics/safety/force_limiter.h"
#include "haptics/sample/hip_sample.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/shading/first_goal.h"
#include "haptics/shading/force_shading.h"
#include "haptics/shading/turned_normal.h"
#include "haptics/surface/plain_sample.h"
#include "haptics/surface/surface_sample.h"

#include <type_traits>
#include <variant>

namespace touchstone {

namespace {

/// The felt shape at the final proxy: which way it pushes and how deep the HIP is, for each shading model.
struct FeltShape {
    glm::dvec3 normal{0.0}; ///< unit, reference object frame
    double depth = 0.0;     ///< reference object units
};

/// The force of one facet turned. Out of line: what a scene does not call for must not take registers from
/// what it does.
[[gnu::noinline]] FeltShape turnedShape(const HapticScene& scene, ObjectMotions motions,
                                        const HapticSettings& settings, int reference, const Contact& facet,
                                        const glm::dvec3& offset, const FeltShape& shape) {
    const TurnedNormal turned = turnedNormal(scene, motions, settings, reference, facet, shape.normal);
    if (turned.cosine == 1.0)
        return {turned.normal, shape.depth};
    return {turned.normal, glm::dot(offset, facet.normal) / turned.cosine};
}

/// Of all that is touched as one: `oneFacet` where some surface of the scene turns the force of its facet.
[[gnu::always_inline]] inline FeltShape feltShape(const HapticScene& scene, ObjectMotions motions,
                                                  const HapticSettings& settings, bool oneFacet,
                                                  const glm::dvec3& hip, const DeviceState& state,
                                                  const SubGoal& hold) {
    const glm::dvec3 offset = state.proxy - hip;
    const double depth = glm::length(offset);
    const Contact& holder = state.rest.contacts[hold.count > 0 ? static_cast<size_t>(hold.active[0]) : 0];
    const FeltShape shape{depth > 100.0 * kContactGap ? offset / depth : holder.normal, depth};
    if (oneFacet && hold.count == 1)
        return turnedShape(scene, motions, settings, state.reference, holder, offset, shape);
    return shape;
}

/// Velocity of the HIP against the reference object's surface, m/s, in the reference object frame.
glm::dvec3 surfaceVelocity(const TickInput& input, const ObjectMotion& reference, const DeviceState& state) {
    const Similarity& now = reference.workspaceFromObject;
    glm::dvec3 carried(0.0);
    if (!input.objects.empty() && !reference.jumped)
        carried = (now.point(state.proxy) - reference.before.point(state.proxy)) / input.dt;
    return glm::conjugate(now.rotation) * (state.velocity - carried);
}

/// Stage 5 where the touched material calls for it. `velocity` of the HIP against the surface.
[[gnu::noinline]] void feelTexture(const HapticScene& scene, ObjectMotions motions,
                                   const HapticSettings& settings, const DeviceState& state,
                                   const Contact& contact, const glm::dvec3& normal, double depth,
                                   const glm::dvec3& velocity, double dt, SurfaceSample& feel) {
    const double speed = glm::length(velocity - glm::dot(velocity, normal) * normal);
    feel = readSurface(scene, motions, settings, state.reference, contact, normal, depth, speed, dt);
}

/// Stages 5 and 7 but for friction, where each of several contacts has its say.
struct SeveralContacts {
    glm::dvec3 force{0.0}; ///< elastic and damping, N, reference object frame
    FrictionCone cone;
};

/// `feel` becomes that of the contact which carries most, with the direction of the whole elastic force.
/// `velocity` of the HIP against the surface; the force has `zoom` taken out, and is what the device bears.
[[gnu::noinline]] void feelSeveral(const HapticScene& scene, ObjectMotions motions,
                                   const HapticSettings& settings, const DeviceState& state,
                                   const SubGoal& hold, const glm::dvec3& offset,
                                   double workspacePerReference, const glm::dvec3& velocity, double zoom,
                                   double dt, SurfaceSample& feel, SeveralContacts& several) {
    ContactLoads loads;
    readLoads(scene, motions, settings, state.reference, state.rest, hold, state.shaded, offset,
              workspacePerReference, velocity, zoom, dt, loads);
    const glm::dvec3 elastic = elasticForce(loads), felt = velocity / std::max(zoom, 1.0);
    several.force = elastic + dampingForce(loads, felt);
    several.cone = FrictionCone(loads, felt, workspacePerReference);
    feel = loads.contacts[static_cast<size_t>(loads.loaded)].feel;
    const double force = glm::length(elastic);
    if (force > 0.0 && glm::length(offset) > 100.0 * kContactGap)
        feel.textured = elastic / force;
    for (size_t i = 0; i < static_cast<size_t>(loads.count); ++i)
        feel.tiltCompressed |= loads.contacts[i].feel.tiltCompressed;
}

/// True where the planes need not be told apart: all of one plain material without damping whose force
/// nothing turns, which gives K (p - h) whichever of them carries it; or none of them carries anything
/// (RayProxy between planes that leave it no room).
bool feltAsOne(const HapticScene& scene, const HapticSettings& settings, bool oneFacet,
               const SolveResult& rest, const SubGoal& hold) {
    if (kPlainTick || !(hold.multiplier[0] + hold.multiplier[1] + hold.multiplier[2] > 0.0))
        return true;
    if (oneFacet)
        return false;
    const auto contactAt = [&](size_t i) -> const Contact& {
        return rest.contacts[static_cast<size_t>(hold.active[i])];
    };
    const HapticMaterialData& material = materialOf(scene, contactAt(0));
    if (!feelsPlain(material, settings) || specifiedDamping(material, settings) > 0.0)
        return false;
    for (size_t i = 1; i < static_cast<size_t>(hold.count); ++i)
        if (&materialOf(scene, contactAt(i)) != &material)
            return false;
    return true;
}

/// What holds the hand, before friction moves the proxy away from there.
void publishContact(const Similarity& workspaceFromReference, const SolveResult& rest,
                    const SurfaceSample& feel, HapticOutput& output) {
    output.contacts = rest.contactCount;
    if (!feel.touching)
        return;
    output.object = feel.object;
    output.triangle = static_cast<int>(feel.triangle);
    output.normal = workspaceFromReference.direction(feel.textured);
    output.height = feel.height;
    output.planeCount = static_cast<uint32_t>(rest.activeSet.count);
    for (size_t i = 0; i < output.planeCount; ++i)
        output.planes[i] = workspaceFromReference.direction(
            rest.contacts[static_cast<size_t>(rest.activeSet.active[i])].normal);
}

void publishProxy(const Similarity& workspaceFromReference, const DeviceState& state, const SolveResult& rest,
                  HapticOutput& output) {
    output.proxy = workspaceFromReference.point(state.proxy);
    output.penetration = glm::length(output.proxy - output.hip);
    output.iterations = rest.iterations;
    output.friction = state.friction;
    if (state.friction != FrictionState::Free)
        output.stictionPoint = workspaceFromReference.point(state.stictionPoint);
}

/// True where no material of the scene calls for stages 4 to 6.
bool callsForNoEffect(const HapticScene& scene, const HapticSettings& settings) {
    return kPlainTick || (scene.plan.plainSample && !(settings.staticFriction > 0.0) &&
                          !(scene.plan.dampingMap && settings.damping > 0.0) &&
                          (!scene.plan.anyShading ||
                           (!anyTwoPass(scene.plan, settings) && !anyOneFacet(scene.plan, settings))));
}

/// What stages 5 to 7 give.
struct Felt {
    glm::dvec3 force{0.0}; ///< N, reference object frame
    double share = 1.0;    ///< of it that the device bears
    int object = -1;       ///< HapticScene::objects; -1: nothing is touched
};

/// Stages 5 to 7, and of 4 what turns the force alone. `held`: where the proxy was when the tick began;
/// `hip`: reference object frame. Effects: some material of the scene calls for more than a constant
/// stiffness and damping, or several contacts are felt apart.
template <bool Effects, class Solver, class Stopwatch>
Felt sampleSurface(const HapticScene& scene, const HapticSettings& settings, const TickInput& input,
                   ObjectMotions motions, const glm::dvec3& hip, const glm::dvec3& held, const SubGoal& hold,
                   Solver& proxy, DeviceState& state, HapticOutput& output, Stopwatch& stopwatch) {
    SolveResult& rest = state.rest;
    const Similarity& workspaceFromReference =
        motions[static_cast<size_t>(state.reference)].workspaceFromObject;
    const bool oneFacet = Effects && anyOneFacet(scene.plan, settings);
    const bool asOne = !Effects || hold.count <= 1 || feltAsOne(scene, settings, oneFacet, rest, hold);
    FeltShape shape;
    if (rest.contactCount > 0 && asOne)
        shape = feltShape(scene, motions, settings, oneFacet, hip, state, hold);
    stopwatch.lap(Stage::Shading);

    // 5. Surface: what material, attributes and maps are under each contact.
    glm::dvec3 velocity = surfaceVelocity(input, motions[static_cast<size_t>(state.reference)], state);
    SurfaceSample feel;
    [[maybe_unused]] std::conditional_t<Effects, SeveralContacts, std::monostate> several;
    bool plain = true;
    if (rest.contactCount > 0) {
        const Contact& contact = loadedContact(rest, hold);
        const double depth = shape.depth * workspaceFromReference.scale;
        plain = !Effects || (asOne && feelsPlain(materialOf(scene, contact), settings));
        if (plain)
            plainSample(scene, settings, contact, shape.normal, depth, feel);
        else if (asOne)
            feelTexture(scene, motions, settings, state, contact, shape.normal, depth, velocity, input.dt,
                        feel);
        else if constexpr (Effects)
            feelSeveral(scene, motions, settings, state, hold, state.proxy - hip,
                        workspaceFromReference.scale, velocity, output.zoom, input.dt, feel, several);
    }
    if (feel.tiltCompressed)
        output.flags = output.flags | TickFlag::TiltCompressed;
    publishContact(workspaceFromReference, rest, feel, output);
    if (output.zoom > 1.0)
        velocity /= output.zoom;
    stopwatch.lap(Stage::Texture);

    // 6. Friction: the proxy held back inside the cones.
    [[maybe_unused]] glm::dvec3 stretch(0.0);
    if constexpr (!Effects) {
        state.friction = FrictionState::Free;
    } else if (!plain || state.friction != FrictionState::Free) {
        if (asOne)
            several.cone = FrictionCone(feel, velocity, workspaceFromReference.scale);
        stretch = workspaceFromReference.scale *
                  applyFriction(settings.friction, several.cone, held, proxy, state, rest);
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
    const double share =
        output.zoom > 1.0 && asOne ? bearableShare(feel.stiffness, output.zoom, settings, scene.limits) : 1.0;
    return {force, share, feel.touching ? feel.object : -1};
}

/// Out of line: what a scene does not call for must not take registers from what it does.
template <class... Arguments>
[[gnu::noinline]] Felt feelEffects(Arguments&&... arguments) {
    return sampleSurface<true>(arguments...);
}

/// Stages 3 and 4 where two-pass shading moves the proxy. Out of line as all that a scene may not call for.
template <class Solver, class Stopwatch>
[[gnu::noinline]] void solveShaded(const HapticScene& scene, ObjectMotions motions,
                                   const HapticSettings& settings, const glm::dvec3& hip, double travel,
                                   Solver& proxy, DeviceState& state, Stopwatch& stopwatch) {
    const FirstGoal first = firstGoal(scene, settings, state, hip, travel);
    proxy.moveTowards(first.goal);
    stopwatch.lap(Stage::Proxy);
    shadeTwoPass(scene, motions, settings, hip, first, proxy, state, state.rest);
}

/// Stages 2 to 7 for a hand whose place is known. Solver: ProxySolver or ComparisonSolver, stages 2 and 3.
template <class Solver, class Stopwatch>
[[gnu::noinline]] void touch(const HapticScene& scene, const HapticSettings& settings, const TickInput& input,
                             DeviceState& state, HapticOutput& output, Stopwatch& stopwatch) {
    const ObjectMotions motions = input.objects.empty() ? ObjectMotions(scene.restMotions) : input.objects;
    const bool effects = !callsForNoEffect(scene, settings);

    // 2. Contact query: the proxy goes with its object and meets what moved towards it.
    SolveResult& rest = state.rest;
    if (state.reference < 0)
        state.reference = nearestObject(scene, motions, state.hip);
    Solver::followObjects(scene, motions, settings, state, output.flags);
    Solver proxy(scene, motions, settings, state, rest);
    if (!proxy.begin()) {
        state.friction = FrictionState::Free;
        state.shaded = false;
        output.proxy = output.hip;
        output.flags = output.flags | TickFlag::StartedInside;
        return;
    }
    const Similarity workspaceFromReference =
        motions[static_cast<size_t>(state.reference)].workspaceFromObject;
    const glm::dvec3 hip = workspaceFromReference.inversePoint(state.hip);
    const glm::dvec3 held = state.proxy;
    // The place without friction is a god-object of its own, which friction does not hold back [001 §4.1.1]:
    // it goes on from where it was. Not where objects move: what they may have pushed is the proxy.
    if (state.friction != FrictionState::Free && input.objects.empty())
        proxy.resumeFrom(state.frictionless);
    stopwatch.lap(Stage::Contact);

    // 3. Proxy solve: as near to the goal as free space allows; and 4. force shading: the same solve against
    // the interpolated planes.
    if (effects && anyTwoPass(scene.plan, settings)) {
        solveShaded(scene, motions, settings, hip, glm::length(state.travel) / workspaceFromReference.scale,
                    proxy, state, stopwatch);
    } else {
        state.shaded = false; // what was felt before it was switched off is no place to start from again
        proxy.moveTowards(hip);
        stopwatch.lap(Stage::Proxy);
    }
    const SubGoal& hold = state.shaded ? rest.shadedActiveSet : rest.activeSet;

    // 5. to 7. Surface, friction, force.
    const bool varied = effects || (hold.count > 1 && !feltAsOne(scene, settings, false, rest, hold));
    const Felt felt = varied ? feelEffects(scene, settings, input, motions, hip, held, hold, proxy, state,
                                           output, stopwatch)
                             : sampleSurface<false>(scene, settings, input, motions, hip, held, hold, proxy,
                                                    state, output, stopwatch);
    output.force = workspaceFromReference.direction(felt.force);
    if (output.zoom > 1.0)
        output.force *= felt.share;
    output.flags |= rest.flags;
    publishProxy(workspaceFromReference, state, rest, output);
    // What is touched now carries the proxy from here on. A proxy that is walled in by more triangles than a
    // tick can hold feels nothing until the hand is in the open again.
    if (felt.object >= 0 && !input.objects.empty())
        changeReference(state, motions, felt.object);
    if (rest.contactCount == 0 && has(rest.flags, TickFlag::CandidatesFull))
        state.placed = false;
    stopwatch.lap(Stage::Force);
}

/// Touch begins again where the hand is next seen.
[[gnu::noinline]] void beginTouch(DeviceState& state, bool mustLeave) {
    state.forgetTouch();
    state.mustLeave = mustLeave;
}

/// A tick without a sample in a scene that moves: the proxy goes on with the objects, as if the hand stood. A
/// watch that touches goes with its reference object; one in the free would have to know where every object
/// was when the hand was last seen, and begins again.
void followUnseen(const HapticScene& scene, const HapticSettings& settings, ObjectMotions motions,
                  DeviceState& state, uint32_t& flags) {
    if (!state.placed || state.reference < 0)
        return;
    if (comparisonIsReady(scene, settings)) {
        ComparisonSolver::followObjects(scene, motions, settings, state, flags);
        if (settings.contact == ContactMethod::Neighbourhood && !state.watch.touching)
            state.placed = false;
        return;
    }
    leaveComparison(scene, motions, state);
    ProxySolver::followObjects(scene, motions, settings, state, flags);
}

/// The contact models that are there to be compared with the sweep. False where the tick is the sweep's after
/// all: since they miss what they need, or one of them has just been switched off. Out of line: the sweep
/// pays one branch.
template <class Stopwatch>
[[gnu::noinline]] bool touchOtherwise(const HapticScene& scene, const HapticSettings& settings,
                                      const TickInput& input, DeviceState& state, HapticOutput& output,
                                      Stopwatch& stopwatch) {
    if (comparisonIsReady(scene, settings)) {
        touch<ComparisonSolver>(scene, settings, input, state, output, stopwatch);
        return true;
    }
    leaveComparison(scene, input.objects.empty() ? ObjectMotions(scene.restMotions) : input.objects, state);
    if (settings.contact != ContactMethod::Sweep)
        output.flags = output.flags | TickFlag::NeighbourhoodMissing;
    return false;
}

/// The contact model that the settings name.
template <class Stopwatch>
void touchWithModel(const HapticScene& scene, const HapticSettings& settings, const TickInput& input,
                    DeviceState& state, HapticOutput& output, Stopwatch& stopwatch) {
    const bool sweep = settings.contact == ContactMethod::Sweep && !state.watch.touching;
    if (!sweep && touchOtherwise(scene, settings, input, state, output, stopwatch))
        return;
    touch<ProxySolver>(scene, settings, input, state, output, stopwatch);
}

} // namespace

template <class Stopwatch>
void hapticStep(const HapticScene& scene, const HapticSettings& settings, const TickInput& input, WorldState&,
                std::span<DeviceState> states, std::span<HapticOutput> outputs,
                Stopwatch& stopwatch) noexcept {
    for (size_t i = 0; i < states.size(); ++i) {
        stopwatch.start();
        DeviceState& state = states[i];
        HapticOutput& output = outputs[i];
        output = HapticOutput{};

        // 1. Sample.
        const DeviceSample& sample = input.devices[i];
        const Similarity& workspaceFromDevice = sample.mapping.workspaceFromDevice;
        if (sample.begins)
            beginTouch(state, !sample.inSight);
        const bool sampled = takeSample(sample, input.dt, state, output.flags);
        output.zoom = workspaceFromDevice.scale;
        output.hip = output.proxy = state.hip;
        output.hipVelocity = state.velocity;
        stopwatch.lap(Stage::Sample);

        // 2. to 7.
        if (sampled && !scene.objects.empty())
            touchWithModel(scene, settings, input, state, output, stopwatch);
        else if (!input.objects.empty())
            followUnseen(scene, settings, input.objects, state, output.flags);

        // 8. Safety: the only thing that may reach a device.
        const SafetyInputs safety{.limits = scene.limits,
                                  .dt = input.dt,
                                  .inputValid = sampled,
                                  .sampleAge = sample.age,
                                  .forceEnabled = settings.forceEnabled,
                                  .late = input.late,
                                  .passivity = settings.passivity,
                                  .position = sample.position,
                                  .springLength = output.penetration / workspaceFromDevice.scale,
                                  .coupling = sample.mapping.coupling};
        output.command = ForceLimiter::limit(output.force, glm::dvec3(0.0), safety, workspaceFromDevice,
                                             state.limiter, output.flags);
        output.energyBalance = state.limiter.passivity.balance;
        // A hand that was gone for as long as a full force takes to fade may come back anywhere: it is not
        // pulled to where it was, but begins anew.
        // One that never was out of sight (a mouse that is lifted, a recorded path) may go on where it is.
        if (state.unsampled >= kForceRampOutTime)
            beginTouch(state, !sample.inSight);
        output.commandInWorkspace = workspaceFromDevice.direction(output.command.force());
        stopwatch.lap(Stage::Safety);
    }
}

template void hapticStep<NoStopwatch>(const HapticScene&, const HapticSettings&, const TickInput&,
                                      WorldState&, std::span<DeviceState>, std::span<HapticOutput>,
                                      NoStopwatch&) noexcept;
template void hapticStep<StageStopwatch>(const HapticScene&, const HapticSettings&, const TickInput&,
                                         WorldState&, std::span<DeviceState>, std::span<HapticOutput>,
                                         StageStopwatch&) noexcept;
template void hapticStep<SplitStopwatch>(const HapticScene&, const HapticSettings&, const TickInput&,
                                         WorldState&, std::span<DeviceState>, std::span<HapticOutput>,
                                         SplitStopwatch&) noexcept;
template void hapticStep<StageTracer>(const HapticScene&, const HapticSettings&, const TickInput&,
                                      WorldState&, std::span<DeviceState>, std::span<HapticOutput>,
                                      StageTracer&) noexcept;

} // namespace touchstone

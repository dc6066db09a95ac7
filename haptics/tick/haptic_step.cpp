#include "haptics/tick/haptic_step.h"

#include "haptics/comparison/comparison_solver.h"
#include "haptics/proxy/place_proxy.h"
#include "haptics/proxy/proxy_solver.h"
#include "haptics/safety/force_limiter.h"
#include "haptics/sample/hip_sample.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/shading/first_goal.h"
#include "haptics/shading/force_shading.h"
#include "haptics/surface/press_dents.h"
#include "haptics/surface/program_surface.h"
#include "haptics/tick/felt_force.h"
#include "haptics/tick/object_step.h"
#include "haptics/tick/publish_force.h"

#include <cmath>
#include <type_traits>

namespace touchstone {

namespace {

void publishProxy(const Similarity& workspaceFromReference, const DeviceState& state, const SolveResult& rest,
                  HapticOutput& output) {
    output.proxy = workspaceFromReference.point(state.proxy);
    output.penetration = glm::length(output.proxy - output.hip);
    output.iterations = rest.iterations;
    output.friction = state.friction;
    if (state.friction != FrictionState::Free)
        output.stictionPoint = workspaceFromReference.point(state.stictionPoint);
}

/// True where no material of the scene needs stages 4 to 6.
[[gnu::always_inline]] inline bool callsForNoEffect(const HapticScene& scene,
                                                    const HapticSettings& settings) {
    return kPlainTick || (scene.plan.plainSample && !(settings.staticFriction > 0.0) &&
                          !(scene.plan.dampingMap && settings.damping > 0.0) &&
                          (!scene.plan.anyShading ||
                           (!anyTwoPass(scene.plan, settings) && !anyOneFacet(scene.plan, settings))));
}

/// Out of line: code that a scene may not need must not take registers from code that it needs.
template <class... Arguments>
[[gnu::noinline]] Felt feelEffects(Arguments&&... arguments) {
    return feltForce<true>(arguments...);
}

/// Stages 3 and 4 where two-pass shading moves the proxy. Out of line, since a scene may not need it.
template <class Solver, class Stopwatch>
[[gnu::noinline]] void solveShaded(const HandTick& tick, const glm::dvec3& hip, double travel, Solver& proxy,
                                   DeviceState& state, Stopwatch& stopwatch) {
    if (tick.settings.forceShading == ShadingMode::SingleRound) {
        findShaded(hip, proxy, state, state.rest);
        stopwatch.lap(Stage::Proxy);
        shadeSingleRound(tick.scene, tick.motions, tick.settings, hip, proxy, state, state.rest);
        return;
    }
    const FirstGoal first = firstGoal(tick.scene, tick.settings, state, hip, travel);
    proxy.moveTowards(first.goal);
    stopwatch.lap(Stage::Proxy);
    shadeTwoPass(tick.scene, tick.motions, tick.settings, hip, first, proxy, state, state.rest);
}

/// Stages 2 to 7 for a hand whose position is known. Solver: ProxySolver or ComparisonSolver, stages 2 and 3.
template <class Solver, class Stopwatch>
[[gnu::noinline]] void touch(const HandTick& tick, WorldState& world, DeviceState& state,
                             HapticOutput& output, Stopwatch& stopwatch) {
    const bool effects = !callsForNoEffect(tick.scene, tick.settings);

    // 2. Contact query: the proxy moves with its object and is swept against the objects that moved.
    SolveResult& rest = state.rest;
    if (state.reference < 0)
        state.reference = nearestObject(tick.scene, tick.motions, state.hip);
    if (!std::is_same_v<Solver, ProxySolver> || !tick.still || state.jammed.count > 0)
        Solver::followObjects(tick.scene, tick.motions, tick.settings, state, output.flags);
    Solver proxy(tick.scene, tick.motions, tick.settings, state, rest);
    if (!proxy.begin()) {
        state.friction = FrictionState::Free;
        state.shaded = false;
        output.flags = output.flags | TickFlag::StartedInside;
        return;
    }
    const Similarity workspaceFromReference =
        tick.motions[static_cast<size_t>(state.reference)].workspaceFromObject;
    const glm::dvec3 hip = workspaceFromReference.inversePoint(state.hip);
    const glm::dvec3 held = state.proxy;
    // The frictionless place is a god-object of its own, which friction does not hold back [001 §4.1.1]: it
    // resumes from its last place. Not where objects move, since they may have pushed the proxy.
    if (state.friction != FrictionState::Free && !tick.moving)
        proxy.resumeFrom(state.frictionless);
    stopwatch.lap(Stage::Contact);

    // 3. Proxy solve: as near to the goal as free space allows. 4. Force shading: the same solve against the
    // interpolated planes.
    const SubGoal* activeSet = &rest.activeSet;
    if (effects && Solver::shades(tick.settings) && anyTwoPass(tick.scene.plan, tick.settings)) {
        solveShaded(tick, hip, glm::length(state.travel) / workspaceFromReference.scale, proxy, state,
                    stopwatch);
        if (state.shaded)
            activeSet = &rest.shadedActiveSet;
    } else {
        state.shaded = false; // after shading is switched off, its last goal is not a valid start
        proxy.moveTowards(hip);
        stopwatch.lap(Stage::Proxy);
    }

    // 5. to 7. Surface, friction, force.
    const bool varied = effects || (activeSet->count > 1 && !feltAsOne(tick, false, rest, *activeSet));
    const Felt felt = varied ? feelEffects(tick, hip, held, *activeSet, proxy, state, output, stopwatch)
                             : feltForce<false>(tick, hip, held, *activeSet, proxy, state, output, stopwatch);
    publishForce(tick, workspaceFromReference, felt, state.travel, world, output);
    output.flags |= rest.flags;
    publishProxy(workspaceFromReference, state, rest, output);
    // The object touched now becomes the reference object. A proxy surrounded by more triangles than a tick
    // can hold feels nothing until the hand is in free space again.
    if (felt.object >= 0 && tick.moving)
        changeReference(state, tick.motions, felt.object);
    if (rest.contactCount == 0 && has(rest.flags, TickFlag::CandidatesFull))
        state.placed = false;
    stopwatch.lap(Stage::Force);
}

/// A tick without a sample in a moving scene: the proxy moves with the objects as if the hand were at rest. A
/// neighbourhood watch in contact moves with its reference object; one in free space would need every
/// object's pose at the last sample, so it restarts.
void followUnseen(const HandTick& tick, DeviceState& state, uint32_t& flags) {
    if (!state.placed || state.reference < 0)
        return;
    if (comparisonIsReady(tick.scene, tick.settings)) {
        ComparisonSolver::followObjects(tick.scene, tick.motions, tick.settings, state, flags);
        if (tick.settings.contact == ContactMethod::Neighbourhood && !state.watch.touching)
            state.placed = false;
        return;
    }
    leaveComparison(tick.scene, tick.motions, state);
    ProxySolver::followObjects(tick.scene, tick.motions, tick.settings, state, flags);
}

/// The comparison solvers. False where the sweep solves the tick: the data that they need is missing, or one
/// of them has just been switched off. Out of line: the sweep pays one branch.
template <class Stopwatch>
[[gnu::noinline]] bool touchOtherwise(const HandTick& tick, WorldState& world, DeviceState& state,
                                      HapticOutput& output, Stopwatch& stopwatch) {
    if (comparisonIsReady(tick.scene, tick.settings)) {
        touch<ComparisonSolver>(tick, world, state, output, stopwatch);
        return true;
    }
    leaveComparison(tick.scene, tick.motions, state);
    if (tick.settings.contact != ContactMethod::Sweep)
        output.flags = output.flags | TickFlag::NeighbourhoodMissing;
    return false;
}

/// Solves with the contact model that the settings select.
template <class Stopwatch>
void touchWithModel(const HandTick& tick, WorldState& world, DeviceState& state, HapticOutput& output,
                    Stopwatch& stopwatch) {
    const bool sweep = tick.settings.contact == ContactMethod::Sweep && !state.watch.touching;
    if (!sweep && touchOtherwise(tick, world, state, output, stopwatch))
        return;
    touch<ProxySolver>(tick, world, state, output, stopwatch);
}

/// Stages 2 to 7 where a surface may give way.
template <class Stopwatch>
[[gnu::noinline]] void touchSoft(HandTick& tick, bool sampled, WorldState& world, DeviceState& state,
                                 HapticOutput& output, Stopwatch& stopwatch) {
    DentPress press{.dents = state.dents, .maxForce = tick.limits.maxForce, .dt = tick.dt};
    tick.dents = tick.settings.deformation ? &press : nullptr;
    if (sampled)
        touchWithModel(tick, world, state, output, stopwatch);
    else if (tick.moving)
        followUnseen(tick, state, output.flags);
    relaxDents(tick.scene, tick.dt, press.pressed, state.dents);
    if (press.pressed != 0) {
        output.proxy += press.shift;
        output.penetration = glm::length(output.proxy - output.hip);
    }
}

/// Stages 1 to 7 of one hand.
template <class Stopwatch>
void feelHand(const HapticScene& scene, const HapticSettings& settings, const TickInput& input,
              const DeviceSample& sample, WorldState& world, DeviceState& state, HapticOutput& output,
              Stopwatch& stopwatch) {
    output = HapticOutput{};

    // 1. Sample.
    if (sample.begins) {
        beginTouch(state, !sample.inSight);
        if (!sample.inSight)
            ForceLimiter::forgetEnergy(state.limiter); // that of another device, or of before the gap
    }
    const bool sampled = takeSample(sample, input.dt, state, output.flags);
    if (scene.plan.programs && sampled) [[unlikely]]
        followTool(state.velocity, input.dt, state.tool);
    output.zoom = sample.mapping.workspaceFromDevice.scale;
    output.hip = output.proxy = state.hip;
    output.hipVelocity = state.velocity;
    stopwatch.lap(Stage::Sample);

    // 2. to 7.
    ContactForces parts;
    const ObjectMotions moved = world.poses();
    HandTick tick{.scene = scene,
                  .settings = settings,
                  .limits = sample.limits,
                  .motions = moved.empty() ? ObjectMotions(scene.restMotions) : moved,
                  .moving = !moved.empty(),
                  .still = world.still(),
                  .dt = input.dt,
                  .zoom = output.zoom,
                  .parts = world.collectsReactions() ? &parts : nullptr,
                  .textures = world.textures().get()};
    const bool grasps = settings.grasp != GraspMode::Off || state.grasp.object >= 0;
    if (grasps && hold(tick, sample, sampled, world, state, output)) [[unlikely]]
        return;
    if (scene.plan.deformation) [[unlikely]]
        touchSoft(tick, sampled && !scene.objects.empty(), world, state, output, stopwatch);
    else if (sampled && !scene.objects.empty())
        touchWithModel(tick, world, state, output, stopwatch);
    else if (tick.moving)
        followUnseen(tick, state, output.flags);
    if (grasps) [[unlikely]]
        takeHold(tick, sample, world, state, output);
    if (input.tool != nullptr && sampled && (input.tool->held || (sample.buttons & kSculptButton) != 0))
        [[unlikely]]
        resistTool(tick, *input.tool, state, world, output);
}

/// Stage 8 of one hand: the only stage that sends commands to a device.
void limitForce(const HapticSettings& settings, const TickInput& input, const DeviceSample& sample,
                DeviceState& state, HapticOutput& output) {
    const Similarity& workspaceFromDevice = sample.mapping.workspaceFromDevice;
    const SafetyInputs safety{.limits = sample.limits,
                              .dt = input.dt,
                              .inputValid = !has(output.flags, TickFlag::InputInvalid),
                              .sampleAge = sample.age,
                              .forceEnabled = settings.forceEnabled,
                              .late = input.late,
                              .passivity = settings.passivity,
                              .position = sample.position,
                              .springLength = output.penetration / workspaceFromDevice.scale,
                              .coupling = sample.mapping.coupling};
    output.command = ForceLimiter::limit(settings.forceScale * output.force, glm::dvec3(0.0), safety,
                                         workspaceFromDevice, state.limiter, output.flags);
    output.energyBalance = state.limiter.passivity.balance;
    // A hand that was absent for as long as a full force takes to fade may return anywhere: touch begins
    // again instead of pulling it back. A hand that stayed in sight (a lifted mouse, a recorded path) may
    // resume where it is.
    if (state.unsampled >= kForceRampOutTime)
        beginTouch(state, !sample.inSight);
    output.commandInWorkspace = workspaceFromDevice.direction(output.command.force());
}

} // namespace

template <class Stopwatch>
void hapticStep(const HapticScene& compiled, const HapticSettings& settings, const TickInput& input,
                WorldState& world, std::span<DeviceState> states, std::span<HapticOutput> outputs,
                Stopwatch& stopwatch) noexcept {
    stopwatch.start();
    const HapticScene& scene = world.touched(compiled);
    if (world.collectsReactions())
        world.clearReactions();
    for (size_t i = 0; i < states.size(); ++i) {
        stopwatch.hand(i);
        feelHand(scene, settings, input, input.hands[i], world, states[i], outputs[i], stopwatch);
        if (world.held()) [[unlikely]]
            outputs[i].flags = outputs[i].flags | TickFlag::DeformationHeld;
    }
    world.integrate(settings, input.dt);
    for (size_t i = 0; i < states.size(); ++i) {
        stopwatch.hand(i);
        limitForce(settings, input, input.hands[i], states[i], outputs[i]);
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

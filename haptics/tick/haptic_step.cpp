#include "haptics/tick/haptic_step.h"

#include "haptics/comparison/comparison_solver.h"
#include "haptics/proxy/place_proxy.h"
#include "haptics/proxy/proxy_solver.h"
#include "haptics/safety/force_limiter.h"
#include "haptics/sample/hip_sample.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/shading/first_goal.h"
#include "haptics/shading/force_shading.h"
#include "haptics/tick/felt_force.h"

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
bool callsForNoEffect(const HapticScene& scene, const HapticSettings& settings) {
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
[[gnu::noinline]] void solveShaded(const HapticScene& scene, ObjectMotions motions,
                                   const HapticSettings& settings, const glm::dvec3& hip, double travel,
                                   Solver& proxy, DeviceState& state, Stopwatch& stopwatch) {
    if (settings.forceShading == ShadingMode::SingleRound) {
        findShaded(hip, proxy, state, state.rest);
        stopwatch.lap(Stage::Proxy);
        shadeSingleRound(scene, motions, settings, hip, proxy, state, state.rest);
        return;
    }
    const FirstGoal first = firstGoal(scene, settings, state, hip, travel);
    proxy.moveTowards(first.goal);
    stopwatch.lap(Stage::Proxy);
    shadeTwoPass(scene, motions, settings, hip, first, proxy, state, state.rest);
}

/// Stages 2 to 7 for a hand whose position is known. Solver: ProxySolver or ComparisonSolver, stages 2 and 3.
template <class Solver, class Stopwatch>
[[gnu::noinline]] void touch(const HapticScene& scene, const HapticSettings& settings, const TickInput& input,
                             DeviceState& state, HapticOutput& output, Stopwatch& stopwatch) {
    const ObjectMotions motions = input.objects.empty() ? ObjectMotions(scene.restMotions) : input.objects;
    const bool effects = !callsForNoEffect(scene, settings);

    // 2. Contact query: the proxy moves with its object and is swept against the objects that moved.
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
    // The frictionless place is a god-object of its own, which friction does not hold back [001 §4.1.1]: it
    // resumes from its last place. Not where objects move, since they may have pushed the proxy.
    if (state.friction != FrictionState::Free && input.objects.empty())
        proxy.resumeFrom(state.frictionless);
    stopwatch.lap(Stage::Contact);

    // 3. Proxy solve: as near to the goal as free space allows. 4. Force shading: the same solve against the
    // interpolated planes.
    if (effects && anyTwoPass(scene.plan, settings)) {
        solveShaded(scene, motions, settings, hip, glm::length(state.travel) / workspaceFromReference.scale,
                    proxy, state, stopwatch);
    } else {
        state.shaded = false; // after shading is switched off, its last goal is not a valid start
        proxy.moveTowards(hip);
        stopwatch.lap(Stage::Proxy);
    }
    const SubGoal& activeSet = state.shaded ? rest.shadedActiveSet : rest.activeSet;

    // 5. to 7. Surface, friction, force.
    const bool varied =
        effects || (activeSet.count > 1 && !feltAsOne(scene, settings, false, rest, activeSet));
    const Felt felt = varied ? feelEffects(scene, settings, input, motions, hip, held, activeSet, proxy,
                                           state, output, stopwatch)
                             : feltForce<false>(scene, settings, input, motions, hip, held, activeSet, proxy,
                                                state, output, stopwatch);
    output.force = workspaceFromReference.direction(felt.force);
    if (output.zoom > 1.0)
        output.force *= felt.share;
    output.flags |= rest.flags;
    publishProxy(workspaceFromReference, state, rest, output);
    // The object touched now becomes the reference object. A proxy surrounded by more triangles than a tick
    // can hold feels nothing until the hand is in free space again.
    if (felt.object >= 0 && !input.objects.empty())
        changeReference(state, motions, felt.object);
    if (rest.contactCount == 0 && has(rest.flags, TickFlag::CandidatesFull))
        state.placed = false;
    stopwatch.lap(Stage::Force);
}

/// Touch begins again where the hand is next sampled.
[[gnu::noinline]] void beginTouch(DeviceState& state, bool mustLeave) {
    state.forgetTouch();
    state.mustLeave = mustLeave;
}

/// A tick without a sample in a moving scene: the proxy moves with the objects as if the hand were at rest. A
/// neighbourhood watch in contact moves with its reference object; one in free space would need every
/// object's pose at the last sample, so it restarts.
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

/// The comparison solvers. False where the sweep solves the tick: the data that they need is missing, or one
/// of them has just been switched off. Out of line: the sweep pays one branch.
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

/// Solves with the contact model that the settings select.
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

        // 8. Safety: the only stage that sends commands to a device.
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
        // A hand that was absent for as long as a full force takes to fade may return anywhere: touch begins
        // again instead of pulling it back. A hand that stayed in sight (a lifted mouse, a recorded path) may
        // resume where it is.
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

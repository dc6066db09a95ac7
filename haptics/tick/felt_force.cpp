#include "haptics/tick/felt_force.h"

#include "haptics/surface/press_dents.h"
#include "haptics/surface/program_surface.h"

#include <algorithm>
#include <optional>

namespace touchstone {

namespace {

/// Object and place of every active contact; the first one where no plane holds.
void nameContacts(const DeviceState& state, const SubGoal& activeSet, ContactForces& parts) {
    parts.count = static_cast<size_t>(std::max(activeSet.count, 1));
    for (size_t i = 0; i < parts.count; ++i) {
        const Contact& contact =
            state.rest.contacts[activeSet.count > 0 ? static_cast<size_t>(activeSet.active[i]) : 0];
        parts.object[i] = contact.object;
        parts.point[i] = contact.point;
        parts.force[i] = glm::dvec3(0.0);
        parts.load[i] = parts.grip[i] = 0.0;
    }
}

/// Programs of this tick at contacts whose common normal is `normal`.
ProgramRun beginPrograms(const HandTick& tick, DeviceState& state, const glm::dvec3& normal,
                         const glm::dvec3& velocity) {
    followDirection(velocity, normal, tick.motions[static_cast<size_t>(state.reference)].workspaceFromObject,
                    state.tool);
    return programRun(state.tool, velocity, tick.zoom, tick.dt, tick.textures);
}

void publishEnd(const ProgramRun& programs, HapticOutput& output) {
    output.programEnd = programs.end;
    if (programs.end.ending != program::Ending::Finished)
        output.flags = output.flags | TickFlag::ProgramFailed;
}

} // namespace

FeltShape turnedShape(const HandTick& tick, int reference, const Contact& facet, const glm::dvec3& offset,
                      const FeltShape& shape) {
    const TurnedNormal turned =
        turnedNormal(tick.scene, tick.motions, tick.settings, reference, facet, shape.normal);
    if (turned.cosine == 1.0)
        return {turned.normal, shape.depth};
    return {turned.normal, glm::dot(offset, facet.normal) / turned.cosine};
}

void feelTexture(const HandTick& tick, DeviceState& state, const Contact& contact, const glm::dvec3& normal,
                 double depth, const glm::dvec3& velocity, SurfaceSample& feel, HapticOutput& output) {
    const double speed = glm::length(velocity - glm::dot(velocity, normal) * normal);
    feel = readSurface(tick.scene, tick.motions, tick.settings, tick.limits, state.reference, contact, normal,
                       depth, speed, tick.dt);
    if (tick.scene.plan.programs) {
        ProgramRun programs = beginPrograms(tick, state, normal, velocity);
        runProgram(tick.scene, tick.motions, tick.settings, tick.limits, state.reference, contact, depth,
                   programs, feel);
        publishEnd(programs, output);
    }
    if (tick.dents != nullptr)
        pressDents(tick.scene, tick.motions, state.reference, contact, speed, *tick.dents, feel);
}

void feelSeveral(const HandTick& tick, DeviceState& state, const SubGoal& activeSet, const glm::dvec3& offset,
                 double workspacePerReference, const glm::dvec3& velocity, SurfaceSample& feel,
                 SeveralContacts& several, HapticOutput& output) {
    ContactLoads loads;
    std::optional<ProgramRun> programs;
    if (tick.scene.plan.programs) {
        const double length = glm::length(offset);
        programs.emplace(
            beginPrograms(tick, state, length > 0.0 ? offset / length : glm::dvec3(0.0), velocity));
    }
    readLoads(tick.scene, tick.motions, tick.settings, tick.limits, state.reference, state.rest, activeSet,
              state.shaded, offset, workspacePerReference, velocity, tick.zoom, tick.dt,
              programs ? &*programs : nullptr, tick.dents, loads);
    if (programs)
        publishEnd(*programs, output);
    const glm::dvec3 elastic = elasticForce(loads), felt = velocity / std::max(tick.zoom, 1.0);
    several.force = elastic + dampingForce(loads, felt);
    several.cone = FrictionCone(loads, felt, workspacePerReference);
    feel = loads.contacts[static_cast<size_t>(loads.loaded)].feel;
    const double force = glm::length(elastic);
    if (force > 0.0 && glm::length(offset) > 100.0 * kContactGap)
        feel.textured = elastic / force;
    for (size_t i = 0; i < static_cast<size_t>(loads.count); ++i)
        feel.tiltCompressed |= loads.contacts[i].feel.tiltCompressed;
    if (tick.parts != nullptr) {
        nameContacts(state, activeSet, *tick.parts);
        splitForces(loads, felt, *tick.parts);
    }
}

void splitPlain(const HandTick& tick, const DeviceState& state, const SubGoal& activeSet, double stiffness,
                double workspacePerReference) {
    ContactForces& parts = *tick.parts;
    nameContacts(state, activeSet, parts);
    for (size_t i = 0; i < static_cast<size_t>(activeSet.count); ++i) {
        const auto at = static_cast<size_t>(activeSet.active[i]);
        const glm::dvec3& plane =
            state.shaded ? state.rest.shadedPlanes[at].normal : state.rest.contacts[at].normal;
        parts.load[i] = parts.grip[i] = stiffness * workspacePerReference * activeSet.multiplier[i];
        parts.force[i] = parts.load[i] * plane;
    }
}

bool feltAsOne(const HandTick& tick, bool oneFacet, const SolveResult& rest, const SubGoal& activeSet) {
    const HapticScene& scene = tick.scene;
    const HapticSettings& settings = tick.settings;
    if (kPlainTick || !(activeSet.multiplier[0] + activeSet.multiplier[1] + activeSet.multiplier[2] > 0.0))
        return true;
    if (oneFacet)
        return false;
    const auto contactAt = [&](size_t i) -> const Contact& {
        return rest.contacts[static_cast<size_t>(activeSet.active[i])];
    };
    const HapticMaterialData& material = materialOf(scene, contactAt(0));
    if (!feelsPlain(material, settings) || specifiedDamping(material, settings) > 0.0)
        return false;
    for (size_t i = 1; i < static_cast<size_t>(activeSet.count); ++i)
        if (&materialOf(scene, contactAt(i)) != &material)
            return false;
    return true;
}

} // namespace touchstone

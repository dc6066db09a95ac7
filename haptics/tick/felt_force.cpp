#include "haptics/tick/felt_force.h"

#include <algorithm>

namespace touchstone {

FeltShape turnedShape(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                      int reference, const Contact& facet, const glm::dvec3& offset, const FeltShape& shape) {
    const TurnedNormal turned = turnedNormal(scene, motions, settings, reference, facet, shape.normal);
    if (turned.cosine == 1.0)
        return {turned.normal, shape.depth};
    return {turned.normal, glm::dot(offset, facet.normal) / turned.cosine};
}

void feelTexture(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                 const DeviceState& state, const Contact& contact, const glm::dvec3& normal, double depth,
                 const glm::dvec3& velocity, double dt, SurfaceSample& feel) {
    const double speed = glm::length(velocity - glm::dot(velocity, normal) * normal);
    feel = readSurface(scene, motions, settings, state.reference, contact, normal, depth, speed, dt);
}

void feelSeveral(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                 const DeviceState& state, const SubGoal& activeSet, const glm::dvec3& offset,
                 double workspacePerReference, const glm::dvec3& velocity, double zoom, double dt,
                 SurfaceSample& feel, SeveralContacts& several) {
    ContactLoads loads;
    readLoads(scene, motions, settings, state.reference, state.rest, activeSet, state.shaded, offset,
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

bool feltAsOne(const HapticScene& scene, const HapticSettings& settings, bool oneFacet,
               const SolveResult& rest, const SubGoal& activeSet) {
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

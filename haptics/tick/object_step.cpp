#include "haptics/tick/object_step.h"

#include "haptics/body/hold_body.h"
#include "haptics/force/tool_resistance.h"
#include "haptics/proxy/place_proxy.h"
#include "haptics/scene/haptic_scene.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

bool holdsOn(const HapticSettings& settings, const DeviceSample& sample) {
    return settings.grasp == GraspMode::Touch ||
           (settings.grasp == GraspMode::Button && (sample.buttons & kSculptButton) != 0);
}

} // namespace

void pushObjects(const Similarity& workspaceFromReference, const glm::dvec3& force, double share,
                 body::HandPush hand, ContactForces& parts, WorldState& world) {
    if (!std::isfinite(force.x + force.y + force.z))
        return;
    parts.complete(force);
    for (size_t i = 0; i < parts.count; ++i) {
        hand.point = workspaceFromReference.point(parts.point[i]);
        hand.force = -share * workspaceFromReference.direction(parts.force[i]);
        world.push(parts.object[i], hand);
    }
}

void resistTool(const HandTick& tick, const LiveTool& tool, const DeviceState& state, WorldState& world,
                HapticOutput& output) {
    const int object = output.object >= 0 ? output.object : tool.object;
    if (object < 0 || static_cast<size_t>(object) >= tick.scene.objects.size())
        return;
    const auto index = static_cast<size_t>(object);
    const Shape* const shape = tick.scene.objects[index]->shape.get();
    const PotentialField* const field = shape != nullptr ? shape->potential() : nullptr;
    if (field == nullptr)
        return;
    const glm::dvec3 force = toolResistance(*field, tick.motions[index].workspaceFromObject, tool, output.hip,
                                            state.velocity, tick.limits.apparentMass, tick.dt) /
                             output.zoom;
    output.force += force;
    if (tick.parts != nullptr && std::isfinite(force.x + force.y + force.z))
        world.push(object, {.point = output.hip, .force = -force, .most = tick.limits.maxForce}); // a damper
}

bool hold(const HandTick& tick, const DeviceSample& sample, bool sampled, WorldState& world,
          DeviceState& state, HapticOutput& output) {
    if (state.grasp.object < 0)
        return false;
    const bool can = world.bodies() != nullptr && body::canHold(*world.bodies(), state.grasp.object);
    if (!can || !holdsOn(tick.settings, sample)) {
        state.grasp = {};
        letGo(state);
        return false;
    }
    if (!sampled)
        return true;
    const double stated = tick.settings.stiffness > 0.0
                              ? tick.settings.stiffness
                              : std::min(tick.limits.recommendedStiffness, tick.limits.maxStiffness);
    const body::Hold held = body::holdBody(*world.bodies(), tick.motions, state.grasp, output.hip,
                                           output.hipVelocity, stated, tick.limits, tick.dt);
    output.proxy = held.place;
    output.penetration = glm::length(held.place - output.hip);
    output.force = held.force;
    output.object = state.grasp.object;
    output.contacts = 1;
    const double size = glm::length(held.force);
    output.normal = size > 0.0 ? held.force / size : glm::dvec3(0.0, 1.0, 0.0);
    return true;
}

void takeHold(const HandTick& tick, const DeviceSample& sample, const WorldState& world, DeviceState& state,
              const HapticOutput& output) {
    if (state.grasp.object >= 0 || output.object < 0 || !holdsOn(tick.settings, sample) ||
        world.bodies() == nullptr || !body::canHold(*world.bodies(), output.object))
        return;
    const Similarity& pose = tick.motions[static_cast<size_t>(output.object)].workspaceFromObject;
    state.grasp = {output.object, pose.inversePoint(output.proxy), pose.rotation};
}

} // namespace touchstone

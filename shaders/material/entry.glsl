// Runs a haptic program: read after it.

void main() {
    Touch before;
    before.position = touchstone_position;
    before.normal = touchstone_normal;
    before.tangent = touchstone_tangent;
    before.binormal = touchstone_binormal;
    before.uv = touchstone_uv;
    before.toolDirection = touchstone_toolDirection;
    before.toolVelocity = touchstone_toolVelocity;
    before.toolAcceleration = touchstone_toolAcceleration;
    before.force = touchstone_force;
    before.staticFriction = touchstone_material.x;
    before.dynamicFriction = touchstone_material.y;
    before.stiffness = touchstone_material.z;
    before.damping = touchstone_material.w;
    before.filterWidth = touchstone_tick.x;
    before.time = touchstone_tick.y;
    Surface after;
    after.position = before.position;
    after.normal = before.normal;
    after.force = before.force;
    after.staticFriction = before.staticFriction;
    after.dynamicFriction = before.dynamicFriction;
    after.stiffness = before.stiffness;
    after.damping = before.damping;
    after.colour = touchstone_look.rgb;
    after.roughness = touchstone_look.a;
#ifdef TOUCHSTONE_PERSISTENT
    before.persistent = touchstone_persistent;
    after.persistentChange = after.brush = 0.0;
#endif
    touch(before, after);
    touchstone_outPosition = after.position;
    touchstone_outNormal = after.normal;
    touchstone_outForce = after.force;
    touchstone_outMaterial = vec4(after.staticFriction, after.dynamicFriction, after.stiffness, after.damping);
    touchstone_outLook = vec4(after.colour, after.roughness);
#ifdef TOUCHSTONE_PERSISTENT
    touchstone_outPersistent = vec2(after.persistentChange, after.brush);
#endif
}

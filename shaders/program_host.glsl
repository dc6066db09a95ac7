// Where a haptic program is linked into a shader (renderer/program/link_program.h): the program's inputs and outputs
// by the names of material/interface.glsl, and touchstone_run, whose body the program replaces.
vec3 touchstone_position, touchstone_normal, touchstone_tangent, touchstone_binormal;
vec2 touchstone_uv;
vec3 touchstone_toolDirection, touchstone_toolVelocity, touchstone_toolAcceleration, touchstone_force;
vec4 touchstone_material;
vec2 touchstone_tick;
vec4 touchstone_look;
float touchstone_persistent;
vec3 touchstone_outPosition, touchstone_outNormal, touchstone_outForce;
vec4 touchstone_outMaterial, touchstone_outLook;
vec2 touchstone_outPersistent;
bool touchstone_failed; // the budget is spent, an index is outside of its array, an integer is divided by zero

void touchstone_run() { touchstone_failed = true; }

/// Tested by its bits: compilers may take floats for finite.
bool isUnusable(vec4 v) { return any(equal(floatBitsToUint(v) & 0x7f800000u, uvec4(0x7f800000u))); }

/// Runs the program on the inputs; false where it has no result, as for the hand.
bool runProgram() {
    const vec4 never = uintBitsToFloat(uvec4(0x7fc00000u)); // what it never writes
    touchstone_outPosition = touchstone_outNormal = touchstone_outForce = never.xyz;
    touchstone_outMaterial = touchstone_outLook = never;
    touchstone_outPersistent = vec2(0.0); // only programs that name the texture write it
    touchstone_failed = false;
    touchstone_run();
    return !touchstone_failed && !isUnusable(vec4(touchstone_outPosition, touchstone_outForce.x)) &&
           !isUnusable(vec4(touchstone_outNormal, touchstone_outForce.y)) && !isUnusable(touchstone_outMaterial) &&
           !isUnusable(vec4(touchstone_outLook.rgb, touchstone_outForce.z)) && !isUnusable(touchstone_outLook) &&
           !isUnusable(vec4(touchstone_outPersistent, 0.0, 0.0));
}

#version 460
#extension GL_GOOGLE_include_directive : require
// Runs a haptic program at many places, to compare it with the hand's (tests/unit/programs).
#include "program_host.glsl"

layout(local_size_x = 64) in;
/// 13 vec4 of inputs a place, by location.
layout(std430, set = 0, binding = 0) readonly buffer Inputs { vec4 inputs[]; };
/// 7 vec4 a place: the outputs by location, and whether there is a result.
layout(std430, set = 0, binding = 1) writeonly buffer Outputs { vec4 outputs[]; };

void main() {
    const uint place = gl_GlobalInvocationID.x;
    if (place >= uint(outputs.length()) / 7u) return;
    const uint from = 13u * place, to = 7u * place;
    touchstone_position = inputs[from].xyz;
    touchstone_normal = inputs[from + 1u].xyz;
    touchstone_tangent = inputs[from + 2u].xyz;
    touchstone_binormal = inputs[from + 3u].xyz;
    touchstone_uv = inputs[from + 4u].xy;
    touchstone_toolDirection = inputs[from + 5u].xyz;
    touchstone_toolVelocity = inputs[from + 6u].xyz;
    touchstone_toolAcceleration = inputs[from + 7u].xyz;
    touchstone_force = inputs[from + 8u].xyz;
    touchstone_material = inputs[from + 9u];
    touchstone_tick = inputs[from + 10u].xy;
    touchstone_look = inputs[from + 11u];
    touchstone_persistent = inputs[from + 12u].x;
    const bool done = runProgram();
    outputs[to] = vec4(touchstone_outPosition, 0.0);
    outputs[to + 1u] = vec4(touchstone_outNormal, 0.0);
    outputs[to + 2u] = vec4(touchstone_outForce, 0.0);
    outputs[to + 3u] = touchstone_outMaterial;
    outputs[to + 4u] = touchstone_outLook;
    outputs[to + 5u] = vec4(touchstone_outPersistent, 0.0, 0.0);
    outputs[to + 6u] = vec4(done ? 1.0 : 0.0, 0.0, 0.0, 0.0);
}

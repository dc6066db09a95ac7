#version 460
#extension GL_GOOGLE_include_directive : require
// Spheres, cylinders, cones and discs: unit shapes, each instance with its own affine map into the eye frame.
#include "shared/scene_types.h"

layout(set = 0, binding = 0) uniform Frame { FrameUniforms frame; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 row0; // eyeFromShape
layout(location = 3) in vec4 row1;
layout(location = 4) in vec4 row2;
layout(location = 5) in vec4 color;
layout(location = 0) out vec3 eyeNormal;
layout(location = 1) out vec4 shapeColor;

void main() {
    const vec4 p = vec4(position, 1.0);
    const vec3 eye = vec3(dot(row0, p), dot(row1, p), dot(row2, p));
    // Shapes are scaled unevenly along their own axes only, so dividing by the squared lengths inverts the scale.
    const vec3 x = vec3(row0.x, row1.x, row2.x), y = vec3(row0.y, row1.y, row2.y), z = vec3(row0.z, row1.z, row2.z);
    eyeNormal = x * (normal.x / dot(x, x)) + y * (normal.y / dot(y, y)) + z * (normal.z / dot(z, z));
    shapeColor = color;
    gl_Position = frame.clipFromEye * vec4(eye, 1.0);
}

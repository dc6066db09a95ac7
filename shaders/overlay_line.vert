#version 460
#extension GL_GOOGLE_include_directive : require
// A line as a quad of constant width in pixels: four vertices, one instance a line.
#include "shared/scene_types.h"

layout(set = 0, binding = 0) uniform Frame { FrameUniforms frame; };
layout(location = 0) in vec4 from;  // eye frame; w: width in pixels
layout(location = 1) in vec4 to;
layout(location = 2) in vec4 color;
layout(location = 0) out vec4 lineColor;

void main() {
    vec4 a = frame.clipFromEye * vec4(from.xyz, 1.0);
    vec4 b = frame.clipFromEye * vec4(to.xyz, 1.0);
    // What reaches behind the near plane (z < 0) is cut there, else the division turns it round.
    if (a.z < 0.0 && b.z > 0.0) a = mix(a, b, a.z / (a.z - b.z));
    else if (b.z < 0.0 && a.z > 0.0) b = mix(b, a, b.z / (b.z - a.z));
    const vec2 halfImage = 0.5 * frame.image.xy;
    const vec2 along = (b.xy / b.w - a.xy / a.w) * halfImage;
    const float length2 = dot(along, along);
    const vec2 across = length2 > 0.0 ? vec2(-along.y, along.x) * inversesqrt(length2) : vec2(0.0, 1.0);
    vec4 p = (gl_VertexIndex & 1) == 0 ? a : b;
    const float side = (gl_VertexIndex & 2) == 0 ? -0.5 : 0.5;
    p.xy += across * (side * from.w) / halfImage * p.w;
    p.z -= 1e-4 * p.w; // lines that lie on a surface win over it
    lineColor = color;
    gl_Position = p;
}

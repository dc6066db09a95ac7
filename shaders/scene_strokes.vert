#version 460
#extension GL_GOOGLE_include_directive : require
// Line segments and points of the scene as quads of constant width in pixels: four vertices, one instance each. LINES or
// POINTS; without either's normals the material is unlit.
#include "shared/scene_types.h"

layout(constant_id = 0) const uint kFeatures = 0u;
layout(set = 0, binding = 0) uniform Frame { FrameUniforms frame; };
layout(push_constant) uniform Object { ObjectConstants object; };

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 3) in vec2 uv0;
layout(location = 4) in vec2 uv1;
layout(location = 5) in vec4 color;
#ifdef LINES
layout(location = 6) in vec3 toPosition;
layout(location = 7) in vec3 toNormal;
layout(location = 9) in vec2 toUv0;
layout(location = 10) in vec2 toUv1;
layout(location = 11) in vec4 toColor;
#endif

layout(location = 0) out vec3 eyePosition;
layout(location = 1) out vec3 eyeNormal;
layout(location = 2) out vec4 eyeTangent;
layout(location = 3) out vec4 uvs;
layout(location = 4) out vec4 vertexColor;
#ifdef POINTS
layout(location = 5) out vec2 sprite;
#endif

const float kLineWidth = 1.5, kPointSize = 5.0; // nominal pixels

vec3 inEye(vec3 p) {
    const vec4 q = vec4(p, 1.0);
    return vec3(dot(object.eyeFromMesh[0], q), dot(object.eyeFromMesh[1], q), dot(object.eyeFromMesh[2], q));
}

void main() {
    const float side = (gl_VertexIndex & 2) == 0 ? -1.0 : 1.0;
    const vec2 halfImage = 0.5 * frame.image.xy;
    vec3 n = normal;
    uvs = vec4(uv0, uv1);
    vertexColor = color;
    eyeTangent = vec4(0.0);
    eyePosition = inEye(position);
    vec4 p = frame.clipFromEye * vec4(eyePosition, 1.0);
#ifdef LINES
    const bool atEnd = (gl_VertexIndex & 1) != 0;
    const vec3 end = inEye(toPosition);
    vec4 a = p, b = frame.clipFromEye * vec4(end, 1.0);
    // What reaches behind the near plane (z < 0) is cut there, else the division turns it round.
    if (a.z < 0.0 && b.z > 0.0) a = mix(a, b, a.z / (a.z - b.z));
    else if (b.z < 0.0 && a.z > 0.0) b = mix(b, a, b.z / (b.z - a.z));
    const vec2 along = (b.xy / b.w - a.xy / a.w) * halfImage;
    const float length2 = dot(along, along);
    const vec2 across = length2 > 0.0 ? vec2(-along.y, along.x) * inversesqrt(length2) : vec2(0.0, 1.0);
    p = a;
    if (atEnd) {
        p = b;
        eyePosition = end;
        n = toNormal;
        uvs = vec4(toUv0, toUv1);
        vertexColor = toColor;
    }
    p.xy += across * (0.5 * kLineWidth * frame.toViewer.w * side) / halfImage * p.w;
#else
    sprite = vec2((gl_VertexIndex & 1) == 0 ? -1.0 : 1.0, side);
    p.xy += sprite * (0.5 * kPointSize * frame.toViewer.w) / halfImage * p.w;
#endif
    eyeNormal = vec3(dot(object.normalFromMesh[0].xyz, n), dot(object.normalFromMesh[1].xyz, n),
                     dot(object.normalFromMesh[2].xyz, n));
    p.z -= 1e-4 * p.w; // what lies on a surface wins over it
    gl_Position = p;
}

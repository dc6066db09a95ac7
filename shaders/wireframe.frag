#version 460
#extension GL_GOOGLE_include_directive : require
// The edges of triangles over the surface: dark, so that they are seen on bright and on coloured surfaces alike.
#include "shared/scene_types.h"

layout(constant_id = 0) const uint kFeatures = 0u;
layout(push_constant) uniform Object { ObjectConstants object; };

layout(location = 0) in vec3 eyePosition;
layout(location = 0) out vec4 outColor;

void main() {
    if ((kFeatures & kIsClipped) != 0u && dot(object.clip, vec4(eyePosition, 1.0)) > 0.0) discard;
    outColor = vec4(0.01, 0.012, 0.015, object.normalFromMesh[2].w); // the lines' opacity
}

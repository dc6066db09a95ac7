#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/scene_types.h"

layout(set = 0, binding = 0) uniform Frame { FrameUniforms frame; };
layout(location = 0) in vec2 uv; // y up: the scene's viewport is turned over
layout(location = 0) out vec4 outColor;

void main() {
    outColor = vec4(mix(frame.backgroundBottom.rgb, frame.backgroundTop.rgb, smoothstep(0.0, 1.0, uv.y)), 1.0);
}

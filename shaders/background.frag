#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/scene_types.h"

layout(set = 0, binding = 0) uniform Frame { FrameUniforms frame; };
layout(location = 0) out vec4 outColor;

void main() {
    const float down = gl_FragCoord.y / frame.image.y;
    outColor = vec4(mix(frame.backgroundTop.rgb, frame.backgroundBottom.rgb, smoothstep(0.0, 1.0, down)), 1.0);
}

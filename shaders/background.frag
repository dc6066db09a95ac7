#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/scene_types.h"

layout(set = 0, binding = 0) uniform Frame { FrameUniforms frame; };
layout(location = 0) in vec2 uv; // y up: the scene's viewport is turned over
layout(location = 0) out vec4 outColor;
#ifdef KEPT // as in scene.frag: the probe takes nothing away here
layout(location = 1) out vec4 keptFirst;
layout(location = 2) out vec4 keptAround;
layout(location = 3) out vec4 keptTotal;
#endif

void main() {
    outColor = vec4(mix(frame.backgroundBottom.rgb, frame.backgroundTop.rgb, smoothstep(0.0, 1.0, uv.y)), 1.0);
#ifdef KEPT
    keptFirst = keptAround = keptTotal = vec4(0.0);
#endif
}

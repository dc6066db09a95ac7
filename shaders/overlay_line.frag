#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/scene_types.h"

layout(constant_id = 0) const uint kHidden = 0u;
layout(set = 0, binding = 0) uniform Frame { FrameUniforms frame; };
layout(location = 0) in vec4 lineColor;
layout(location = 0) out vec4 outColor;

void main() { outColor = vec4(lineColor.rgb, kHidden != 0u ? lineColor.a * frame.image.z : lineColor.a); }

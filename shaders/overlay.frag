#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/scene_types.h"

layout(constant_id = 0) const uint kHidden = 0u; ///< 1: the pass that shows through the scene
layout(set = 0, binding = 0) uniform Frame { FrameUniforms frame; };
layout(location = 0) in vec3 eyeNormal;
layout(location = 1) in vec4 shapeColor;
layout(location = 0) out vec4 outColor;

void main() {
    const float facing = abs(dot(normalize(eyeNormal), frame.toViewer.xyz));
    const float alpha = kHidden != 0u ? shapeColor.a * frame.image.z : shapeColor.a;
    outColor = vec4(shapeColor.rgb * (0.4 + 0.6 * facing), alpha);
}

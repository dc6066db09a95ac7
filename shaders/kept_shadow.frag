#version 460
#extension GL_GOOGLE_include_directive : require
// Casts the probe's shadow on a picture that was drawn without it (KEPT in scene.frag): takes its share off the light and
// writes the pixels that it changes. On a point or line of the model the shadow is that of each pixel's own place; in
// scene.frag it is that of the point, or of the line's middle.
#include "shared/scene_types.h"

layout(set = 0, binding = 0) uniform Frame { FrameUniforms frame; };
layout(set = 1, binding = 0) uniform sampler2D keptDepth;
layout(set = 1, binding = 1) uniform sampler2D keptFirst;
layout(set = 1, binding = 2) uniform sampler2D keptAround;
layout(set = 1, binding = 3) uniform sampler2D keptTotal;
layout(location = 0) in vec2 uv; // y up: the scene's viewport is turned over
layout(location = 0) out vec4 outColor;

#include "probe_shadow.glsl"
#include "tone.glsl"

void main() {
    const ivec2 pixel = ivec2(gl_FragCoord.xy);
    const vec4 first = texelFetch(keptFirst, pixel, 0), around = texelFetch(keptAround, pixel, 0),
               total = texelFetch(keptTotal, pixel, 0);
    const vec3 n = vec3(first.a, around.a, total.a);
    if (dot(n, n) < 0.25) discard; // background, and what is drawn as it is
    const vec4 p = frame.eyeFromClip * vec4(2.0 * uv - 1.0, texelFetch(keptDepth, pixel, 0).r, 1.0);
    const vec2 taken = 1.0 - leftByProbe(p.xyz / p.w, normalize(n), frame.toLight0.xyz);
    if (max(taken.x, taken.y) < 1.0 / 1024.0) discard; // a quarter of the smallest step of a byte
    outColor = vec4(toneMapped(max(total.rgb - taken.x * first.rgb - taken.y * around.rgb, vec3(0.0))), 1.0);
}

#version 460
#extension GL_GOOGLE_include_directive : require
// What the hand would feel, as colour: a map on the colour scale, the shown normals, or the UV grid.
#include "shared/false_color.h"
#include "shared/scene_types.h"

layout(constant_id = 0) const uint kFeatures = 0u;
layout(constant_id = 1) const uint kView = 0u;
layout(set = 0, binding = 0) uniform Frame { FrameUniforms frame; };
layout(push_constant) uniform Object { ObjectConstants object; };
layout(set = 1, binding = 0) uniform Parameters { FalseColorUniforms parameters; };
layout(set = 1, binding = 1) uniform sampler2D map;

layout(location = 0) in vec3 eyePosition;
layout(location = 1) in vec3 eyeNormal;
layout(location = 2) in vec4 eyeTangent;
layout(location = 3) in vec4 uvs;
layout(location = 5) in float vertexScalar;
layout(location = 0) out vec4 outColor;

#include "surface_normal.glsl"

/// The attachment encodes sRGB; the colours here are meant as they are seen.
vec3 linearFromSrgb(vec3 c) {
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

/// Degrees between the facet and the normal that is felt there.
float tilt(vec3 n, vec2 uv) {
    const vec3 dx = dFdx(eyePosition), dy = dFdy(eyePosition);
    vec3 facet = normalize(cross(dx, dy));
    facet = dot(facet, n) < 0.0 ? -facet : facet;
    vec3 felt = n;
    if (parameters.map.y != 0.0) {
        // The height's gradient along the surface from its change across the pixel (Mikkelsen 2010): n - grad H.
        const float height = parameters.map.y * frame.image.w * texture(map, uv).r;
        const vec3 dyPerp = cross(dy, n), dxPerp = cross(n, dx);
        const float area = dot(dx, dyPerp);
        if (abs(area) > 0.0) felt = normalize(n - (dyPerp * dFdx(height) + dxPerp * dFdy(height)) / area);
    } else if ((kFeatures & kHasNormalTexture) != 0u) {
        const vec3 m = decodeNormal(texture(map, uv).xyz, parameters.map.x);
        felt = (kFeatures & kHasTangents) != 0u ? bendWithTangent(n, eyeTangent, m)
                                                : bendWithDerivatives(n, eyePosition, uv, m);
    }
    return degrees(acos(clamp(dot(facet, felt), -1.0, 1.0)));
}

void main() {
    if ((kFeatures & kIsClipped) != 0u && dot(object.clip, vec4(eyePosition, 1.0)) > 0.0) discard;
    const vec2 set = parameters.uvOffset.z > 0.5 ? uvs.zw : uvs.xy;
    const vec2 uv = vec2(dot(parameters.uvLinear.xy, set), dot(parameters.uvLinear.zw, set)) + parameters.uvOffset.xy;
    vec3 n = normalize(eyeNormal);
    vec3 color;
    if (kView == kShowsMap) {
        // A negative scalar says that nobody states this quantity here.
        const float value = vertexScalar * (parameters.map.x + parameters.map.y * texture(map, uv).r);
        color = vertexScalar < 0.0 ? vec3(0.5) : falseColorAt(value * parameters.map.z + parameters.map.w);
    } else if (kView == kShowsNormals) {
        if ((kFeatures & kHasNormalTexture) != 0u) {
            const vec3 m = decodeNormal(texture(map, uv).xyz, parameters.map.x);
            n = (kFeatures & kHasTangents) != 0u ? bendWithTangent(n, eyeTangent, m)
                                                 : bendWithDerivatives(n, eyePosition, uv, m);
        }
        outColor = vec4(linearFromSrgb(0.5 + 0.5 * (gl_FrontFacing ? n : -n)), 1.0);
        return;
    } else if (kView == kShowsTilt) {
        color = falseColorAt(tilt(gl_FrontFacing ? n : -n, uv) * parameters.map.z + parameters.map.w);
    } else if (kView == kShowsFlat) {
        color = parameters.map.rgb;
    } else {
        // A tenth of a UV unit is one cell; red runs with U, green with V.
        const vec2 cell = floor(uvs.xy * 10.0);
        const float odd = mod(cell.x + cell.y, 2.0);
        color = vec3(fract(uvs.xy), 0.25) * (odd > 0.5 ? 1.0 : 0.72);
    }
    // A little shading keeps the shape readable and the colours comparable.
    const float facing = abs(dot(n, normalize(frame.toEye.xyz - frame.toEye.w * eyePosition)));
    outColor = vec4(linearFromSrgb(color) * (0.45 + 0.55 * facing), 1.0);
}

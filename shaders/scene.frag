#version 460
#extension GL_GOOGLE_include_directive : require
// Metallic-roughness of glTF 2.0 under two directional lights and analytic surroundings (renderer/surroundings.h).
#include "shared/scene_types.h"

layout(constant_id = 0) const uint kFeatures = 0u;
layout(set = 0, binding = 0) uniform Frame { FrameUniforms frame; };
layout(set = 1, binding = 0) uniform Material { MaterialUniforms material; };
layout(set = 1, binding = 1) uniform sampler2D baseColorMap;
layout(set = 1, binding = 2) uniform sampler2D metallicRoughnessMap;
layout(set = 1, binding = 3) uniform sampler2D normalMap;
layout(set = 1, binding = 4) uniform sampler2D occlusionMap;
layout(set = 1, binding = 5) uniform sampler2D emissiveMap;

layout(location = 0) in vec3 eyePosition;
layout(location = 1) in vec3 eyeNormal;
layout(location = 2) in vec4 eyeTangent;
layout(location = 3) in vec4 uvs;
layout(location = 4) in vec4 vertexColor;
layout(location = 0) out vec4 outColor;

#include "surface_normal.glsl"

bool has(uint feature) { return (kFeatures & feature) != 0u; }

vec2 uvOf(uint slot) {
    if (!has(kHasUvTransform)) return uvs.xy;
    const vec4 linear = material.uvLinear[slot], offset = material.uvOffset[slot];
    const vec2 uv = offset.z > 0.5 ? uvs.zw : uvs.xy;
    return vec2(dot(linear.xy, uv), dot(linear.zw, uv)) + offset.xy;
}

/// Light reflected towards v from one direction, times cos: Lambert and GGX with Hammon's approximation of
/// Smith's joint visibility ("PBR diffuse lighting for GGX + Smith", 2017). alpha = roughness^2.
vec3 reflected(vec3 n, vec3 v, vec3 l, float nv, float alpha, vec3 diffuse, vec3 f0) {
    const float nl = clamp(dot(n, l), 0.0, 1.0);
    const vec3 h = normalize(l + v);
    const float nh = clamp(dot(n, h), 0.0, 1.0), vh = clamp(dot(v, h), 0.0, 1.0);
    const float a2 = alpha * alpha;
    const float d = nh * nh * (a2 - 1.0) + 1.0;
    // Visibility is 0.5 / this, and a2 / (pi d^2) the GGX distribution: one division for both.
    const float visibilityDivisor = mix(2.0 * nl * nv, nl + nv, alpha);
    const float grazing = 1.0 - vh;
    const float grazing2 = grazing * grazing;
    const vec3 fresnel = f0 + (1.0 - f0) * (grazing2 * grazing2 * grazing);
    return (diffuse + fresnel * (0.5 * a2 / (visibilityDivisor * d * d))) * (nl * 0.31830989); // 1/pi for both
}

/// Irradiance / pi of the surroundings.
vec3 irradianceAt(vec3 n) {
    const vec4 squares = frame.irradianceSquares * vec4(n.x * n.y, n.y * n.z, n.z * n.x, n.x * n.x);
    const float grey = squares.x + squares.y + squares.z + squares.w + frame.irradiance[0].w * (n.y * n.y);
    return max(frame.irradiance[0].rgb + frame.irradiance[1].rgb * n.x + frame.irradiance[2].rgb * n.y +
                   frame.irradiance[3].rgb * n.z + grey,
               vec3(0.0));
}

/// A lamp, radiance / (1 + s (1 - cos))^2, seen in direction r through a lobe of the same form and sharpness 1 / blur:
/// widths add, and what is wider is fainter: d / (d + s (1 - cos))^2 with d = 1 + s blur.
vec3 lampAround(vec3 r, float blur, vec4 axis, vec3 radiance) {
    const float d = 1.0 + axis.w * blur;
    const float u = d + axis.w * (1.0 - dot(axis.xyz, r));
    return radiance * (d / (u * u));
}

/// Radiance of the surroundings around direction r, with a horizon as wide as the reflection is blurred. Near its
/// middle a GGX lobe is 1 / (1 + 4 (1 - cos) / (2 alpha^2))^2 in the reflected direction, half as sharp as in the normal's.
vec3 surroundings(vec3 r, float roughness, float alpha) {
    const float width = 0.06 + 0.94 * roughness;
    const float above = clamp(0.5 + 0.5 * r.y / width, 0.0, 1.0);
    const vec3 sky = mix(frame.rim.rgb - frame.floorFall.rgb * r.y, frame.horizon.rgb + frame.skyRise.rgb * r.y, above);
    const float blur = 2.0 * alpha * alpha;
    return sky + lampAround(r, blur, frame.lampAxis[0], frame.lampRadiance[0].rgb) +
           lampAround(r, blur, frame.lampAxis[1], frame.lampRadiance[1].rgb);
}

/// What the probe leaves of the first light (x) and of the surroundings (y); lengths in its radii. The shadow widens with
/// the distance along the light and fades as the ball covers less of it; of the surroundings a ball hides
/// cos(angle) (radius / distance)^2.
vec2 leftByProbe(vec3 n, vec3 l) {
    const vec3 away = (frame.probe.xyz - eyePosition) * frame.probe.w;
    const float along = dot(away, l), distance2 = dot(away, away);
    const float width = 1.25 + 0.13 * max(along, 0.0);
    const float cover = 1.0 / (width * width);
    const float inside = max(0.0, 1.0 - max(distance2 - along * along, 0.0) * cover);
    const float shadow = along > -1.0 ? min(1.0, 2.2 * inside) * min(1.0, 1.5 * cover) : 0.0;
    const float nearness = inversesqrt(max(distance2, 1.0));
    return vec2(1.0 - 0.9 * shadow, 1.0 - max(dot(n, away), 0.0) * nearness * nearness * nearness);
}

/// Integral of the specular lobe over a uniform surrounding, as scale of f0 and bias: the fit of Karis, "Physically
/// based shading on mobile" (2014).
vec2 environmentBrdf(float roughness, float nv) {
    const vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    const float a = min(r.x * r.x, exp2(-9.28 * nv)) * r.x + r.y;
    return vec2(-1.04, 1.04) * a + r.zw;
}

/// Khronos' PBR Neutral tone mapper (2024): colours below 0.76 stay what they are, brighter ones are compressed
/// and lose saturation.
vec3 toneMapped(vec3 color) {
    const float start = 0.8 - 0.04, desaturation = 0.15;
    const float low = min(color.r, min(color.g, color.b));
    const float offset = low < 0.08 ? low - 6.25 * low * low : 0.04;
    color -= offset;
    const float peak = max(color.r, max(color.g, color.b));
    if (peak < start) return color;
    const float range = 1.0 - start;
    const float newPeak = 1.0 - range * range / (peak + range - start);
    color *= newPeak / peak;
    const float fade = 1.0 / (desaturation * (peak - newPeak) + 1.0);
    return mix(vec3(newPeak), color, fade);
}

void main() {
    vec4 base = material.baseColor;
    if (has(kHasVertexColor)) base *= vertexColor;
    if (has(kHasBaseColorTexture)) base *= texture(baseColorMap, uvOf(kBaseColorSlot));
    if (has(kIsMasked) && base.a < material.emissiveCutoff.a) discard;

    float metallic = material.factors.x, roughness = material.factors.y, occlusion = 1.0;
    if (has(kHasMetallicRoughnessTexture)) {
        const vec3 texel = texture(metallicRoughnessMap, uvOf(kMetallicRoughnessSlot)).rgb;
        metallic *= texel.b;
        roughness *= texel.g;
        if (has(kSharesOcclusion)) occlusion = 1.0 + material.factors.w * (texel.r - 1.0);
    }
    if (has(kHasOcclusionTexture) && !has(kSharesOcclusion))
        occlusion = 1.0 + material.factors.w * (texture(occlusionMap, uvOf(kOcclusionSlot)).r - 1.0);

    const vec3 v = -normalize(eyePosition);
    vec3 n = normalize(eyeNormal);
    if (has(kHasNormalTexture)) {
        const vec2 uv = uvOf(kNormalSlot);
        const vec3 m = decodeNormal(texture(normalMap, uv).xyz, material.factors.z);
        n = has(kHasTangents) ? bendWithTangent(n, eyeTangent, m) : bendWithDerivatives(n, eyePosition, uv, m);
    }
    if (!gl_FrontFacing) n = -n;

    // Below this roughness a highlight is smaller than a pixel and only flickers.
    roughness = clamp(roughness, 0.06, 1.0);
    const float alpha = roughness * roughness;
    const float nv = clamp(abs(dot(n, v)), 1e-3, 1.0);
    const vec3 f0 = mix(vec3(0.04), base.rgb, metallic);
    const vec3 diffuse = base.rgb * (0.96 * (1.0 - metallic));

    vec2 left = vec2(1.0);
    if (has(kHasProbeShadow)) left = leftByProbe(n, frame.toLight0.xyz);
    vec3 color = frame.irradiance0.rgb * (left.x * reflected(n, v, frame.toLight0.xyz, nv, alpha, diffuse, f0));
    if (has(kHasSecondLight))
        color += frame.irradiance1.rgb * reflected(n, v, frame.toLight1.xyz, nv, alpha, diffuse, f0);
    const vec2 brdf = environmentBrdf(roughness, nv);
    const vec3 r = reflect(-v, n);
    color += (occlusion * left.y) *
             (diffuse * irradianceAt(n) + (f0 * brdf.x + brdf.y) * surroundings(r, roughness, alpha));
    if (has(kHasEmission)) {
        vec3 emission = material.emissiveCutoff.rgb;
        if (has(kHasEmissiveTexture)) emission *= texture(emissiveMap, uvOf(kEmissiveSlot)).rgb;
        color += emission;
    }
    outColor = vec4(toneMapped(color), has(kIsBlended) ? base.a : 1.0);
}

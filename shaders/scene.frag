#version 460
#extension GL_GOOGLE_include_directive : require
// Metallic-roughness of glTF 2.0 under two directional lights and an analytic surrounding.
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

/// Radiance of the surroundings around direction r: floor below, sky above that brightens to the zenith, with a
/// horizon as wide as the reflection is blurred.
vec3 surroundings(vec3 r, float blur) {
    const float width = 0.08 + 0.92 * blur;
    const float above = smoothstep(-width, width, r.y);
    return mix(frame.floorLight.rgb * (1.0 + 0.4 * r.y), frame.sky.rgb * (0.75 + 0.5 * r.y), above);
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

    vec3 color = frame.irradiance0.rgb * reflected(n, v, frame.toLight0.xyz, nv, alpha, diffuse, f0);
    if (has(kHasSecondLight))
        color += frame.irradiance1.rgb * reflected(n, v, frame.toLight1.xyz, nv, alpha, diffuse, f0);
    const vec2 brdf = environmentBrdf(roughness, nv);
    const vec3 r = reflect(-v, n);
    color += occlusion * (diffuse * surroundings(n, 1.0) + (f0 * brdf.x + brdf.y) * surroundings(r, roughness));
    if (has(kHasEmission)) {
        vec3 emission = material.emissiveCutoff.rgb;
        if (has(kHasEmissiveTexture)) emission *= texture(emissiveMap, uvOf(kEmissiveSlot)).rgb;
        color += emission;
    }
    outColor = vec4(toneMapped(color), has(kIsBlended) ? base.a : 1.0);
}

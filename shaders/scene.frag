#version 460
#extension GL_GOOGLE_include_directive : require
// glTF 2.0's metallic-roughness, its KHR_materials_* looks and unlit colours, under two directional lights and the
// surroundings (renderer/surroundings.h, renderer/environment.h). TRANSMISSIVE adds the share of what lies behind, for
// blending with two sources; POINTS cuts squares to discs; PROGRAM lets a haptic program decide on colour, roughness and
// normal; KEPT draws without the probe's shadow and adds what
// kept_shadow.frag needs to cast it afterwards.
#include "shared/scene_types.h"

layout(constant_id = 0) const uint kFeatures = 0u;
layout(set = 0, binding = 0) uniform Frame { FrameUniforms frame; };
layout(set = 0, binding = 1) uniform samplerCube environmentMap;
layout(push_constant) uniform Object { ObjectConstants object; };
layout(set = 1, binding = 0) uniform Material { MaterialUniforms material; };
// Binding 1 + slot.
layout(set = 1, binding = 1) uniform sampler2D baseColorMap;
layout(set = 1, binding = 2) uniform sampler2D metallicRoughnessMap;
layout(set = 1, binding = 3) uniform sampler2D normalMap;
layout(set = 1, binding = 4) uniform sampler2D occlusionMap;
layout(set = 1, binding = 5) uniform sampler2D emissiveMap;
layout(set = 1, binding = 6) uniform sampler2D specularGlossinessMap;
layout(set = 1, binding = 7) uniform sampler2D specularMap;
layout(set = 1, binding = 8) uniform sampler2D specularColorMap;
layout(set = 1, binding = 9) uniform sampler2D clearcoatMap;
layout(set = 1, binding = 10) uniform sampler2D clearcoatRoughnessMap;
layout(set = 1, binding = 11) uniform sampler2D sheenColorMap;
layout(set = 1, binding = 12) uniform sampler2D sheenRoughnessMap;
layout(set = 1, binding = 13) uniform sampler2D transmissionMap;
layout(set = 1, binding = 14) uniform sampler2D thicknessMap;

layout(location = 0) in vec3 eyePosition;
layout(location = 1) in vec3 eyeNormal;
layout(location = 2) in vec4 eyeTangent;
layout(location = 3) in vec4 uvs;
layout(location = 4) in vec4 vertexColor;
#ifdef POINTS
layout(location = 5) in vec2 sprite; ///< -1..1 across the point
#endif
#ifdef TRANSMISSIVE
layout(location = 0, index = 0) out vec4 outColor;
layout(location = 0, index = 1) out vec4 outThrough; ///< factor of what lies behind
#else
layout(location = 0) out vec4 outColor;
#endif
#ifdef KEPT
// Linear light that the probe may take away: all of the first light, all of the surroundings; and the light in all. In
// the alphas the normal; zero where nothing is to be taken away.
layout(location = 1) out vec4 keptFirst;
layout(location = 2) out vec4 keptAround;
layout(location = 3) out vec4 keptTotal;

// White in any case; an infinity of the half floats would become NaN, which is black.
vec4 kept(vec3 light, float normal) { return vec4(clamp(light, vec3(0.0), vec3(60000.0)), normal); }
#endif

bool has(uint feature) { return (kFeatures & feature) != 0u; }

vec2 uvOf(uint slot) {
    if (!has(kHasUvTransform)) return uvs.xy;
    const vec4 linear = material.uvLinear[slot], offset = material.uvOffset[slot];
    const vec2 uv = offset.z > 0.5 ? uvs.zw : uvs.xy;
    return vec2(dot(linear.xy, uv), dot(linear.zw, uv)) + offset.xy;
}

#include "surface_normal.glsl"
#ifdef PROGRAM
#include "program_surface.glsl"
#endif
#include "probe_shadow.glsl"
#include "surface_light.glsl"
#include "material_layers.glsl"
#include "tone.glsl"

vec4 baseColor() {
    vec4 base = material.baseColor;
    if (has(kHasVertexColor)) base *= vertexColor;
    if (has(kHasBaseColorTexture)) base *= texture(baseColorMap, uvOf(kBaseColorSlot));
    return base;
}

vec3 emission() {
    vec3 color = material.emissiveCutoff.rgb;
    if (has(kHasEmissiveTexture)) color *= texture(emissiveMap, uvOf(kEmissiveSlot)).rgb;
    return color;
}

/// Metallic-roughness, with KHR_materials_ior and KHR_materials_specular. Roughness is not yet limited.
Surface metallicRoughness(vec3 base, inout float metallic, inout float occlusion) {
    float roughness = material.factors.y;
    metallic = material.factors.x;
    if (has(kHasMetallicRoughnessTexture)) {
        const vec3 texel = texture(metallicRoughnessMap, uvOf(kMetallicRoughnessSlot)).rgb;
        metallic *= texel.b;
        roughness *= texel.g;
        if (has(kSharesOcclusion)) occlusion = 1.0 + material.factors.w * (texel.r - 1.0);
    }
    vec3 dielectric = vec3(0.04);
    float f90 = 1.0, below = 0.96;
    if (has(kHasSpecular)) {
        dielectric = material.dielectric.rgb;
        float share = material.dielectric.a;
        if (has(kHasSpecularTextures)) {
            dielectric *= texture(specularColorMap, uvOf(kSpecularColorSlot)).rgb;
            share *= texture(specularMap, uvOf(kSpecularSlot)).a;
        }
        dielectric = min(dielectric, vec3(1.0)) * share;
        below = 1.0 - largest(dielectric);
        f90 = mix(share, 1.0, metallic);
    }
    return Surface(base * (below * (1.0 - metallic)), mix(dielectric, base, metallic), f90, roughness, 0.0, vec3(1.0));
}

/// KHR_materials_pbrSpecularGlossiness.
Surface specularGlossiness(vec3 base) {
    vec4 look = material.specularGlossiness;
    if (has(kHasSpecularGlossinessTexture)) look *= texture(specularGlossinessMap, uvOf(kSpecularGlossinessSlot));
    return Surface(base * (1.0 - largest(look.rgb)), look.rgb, 1.0, 1.0 - look.a, 0.0, vec3(1.0));
}

/// What the surface sends where the probe leaves it `left` of the lights; `scattered`: of the light from behind.
vec3 lit(Surface s, vec3 specular, vec3 n, vec3 smoothNormal, vec3 v, float nv, float occlusion, vec3 scattered,
         vec2 left) {
    vec3 color = frame.irradiance0.rgb * (left.x * reflected(s, n, v, frame.toLight0.xyz, nv));
    if (has(kHasSecondLight)) color += frame.irradiance1.rgb * reflected(s, n, v, frame.toLight1.xyz, nv);
    const vec3 r = reflect(-v, n);
    left.y *= occlusion;
    color += left.y * (s.diffuse * irradianceAt(n) + specular * surroundings(r, s.roughness, s.alpha));
    if (has(kIsTransmissive)) color += scattered;
    if (has(kHasSheen)) color = underSheen(color, n, v, nv, left);
    if (has(kHasEmission)) color += emission();
    if (has(kHasClearcoat)) color = underCoat(color, smoothNormal, v, left);
    return color;
}

/// Writes what the surface sends (linear, not tone mapped) and the share `through` of what lies behind it.
void writeOver(vec3 color, vec3 through, float alpha) {
    // What lies behind has been through the tone mapper's toe already.
    color = compressed(color) * alpha;
    through = mix(vec3(1.0), through, alpha);
#ifdef TRANSMISSIVE
    outColor = vec4(color, 1.0);
    outThrough = vec4(through, 1.0);
#else
    const float opaque = clamp(1.0 - dot(through, vec3(1.0 / 3.0)), 0.004, 1.0); // blending with one source: grey
    outColor = vec4(color / opaque, opaque);
#endif
}

/// An inner side of a body that is filled (object.normalFromMesh[2].w) is seen through the face that cuts it: the line
/// of sight enters the body there, since it leaves it here and meets nothing between.
bool showsFace() {
    return has(kIsClipped) && !gl_FrontFacing && object.normalFromMesh[2].w > 0.5;
}

void main() {
#ifdef POINTS
    if (dot(sprite, sprite) > 1.0) discard;
#endif
    if (has(kIsClipped) && dot(object.clip, vec4(eyePosition, 1.0)) > 0.0) discard;
    vec4 base = baseColor();
#ifdef PROGRAM
    const Programmed programmed = programmedSurface(base.rgb);
    base.rgb = programmed.color;
#endif
    if (has(kIsMasked) && base.a < material.emissiveCutoff.a) discard;
    const float alpha = has(kIsBlended) && !has(kIsSolid) ? base.a : 1.0;
    if (has(kIsUnlit)) { // as it is, without tone mapping
        outColor = vec4(has(kHasEmission) ? base.rgb + emission() : base.rgb, alpha);
#ifdef KEPT
        keptFirst = keptAround = keptTotal = vec4(0.0);
#endif
        return;
    }

    float metallic = 0.0, occlusion = 1.0;
    Surface s;
    if (has(kHasSpecularGlossiness)) s = specularGlossiness(base.rgb);
    else s = metallicRoughness(base.rgb, metallic, occlusion);
#ifdef PROGRAM
    s.roughness = programmed.roughness;
#endif
    // Below this roughness a highlight is smaller than a pixel and only flickers.
    s.roughness = clamp(s.roughness, 0.06, 1.0);
    s.alpha = s.roughness * s.roughness;
    if (has(kHasOcclusionTexture) && !has(kSharesOcclusion))
        occlusion = 1.0 + material.factors.w * (texture(occlusionMap, uvOf(kOcclusionSlot)).r - 1.0);

    const vec3 v = normalize(frame.toEye.xyz - frame.toEye.w * eyePosition);
    vec3 n = normalize(eyeNormal), place = eyePosition;
    vec3 smoothNormal = n;
    if (has(kHasNormalTexture)) {
        const vec2 uv = uvOf(kNormalSlot);
        const vec3 m = decodeNormal(texture(normalMap, uv).xyz, material.factors.z);
        n = has(kHasTangents) ? bendWithTangent(n, eyeTangent, m) : bendWithDerivatives(n, eyePosition, uv, m);
    }
#ifdef PROGRAM
    n = normalize(n + programmed.bend);
#endif
    if (!gl_FrontFacing && !has(kIsLines | kIsPoints)) {
        n = -n;
        smoothNormal = -smoothNormal;
    }
    if (showsFace()) { // before this inner side, where the line of sight meets the plane
        n = normalize(object.clip.xyz);
        n = dot(n, v) < 0.0 ? -n : n;
        smoothNormal = n;
        place -= v * (dot(object.clip, vec4(place, 1.0)) / dot(object.clip.xyz, v));
    }
    const float nv = clamp(abs(dot(n, v)), 1e-3, 1.0);

    vec3 through = vec3(0.0);
    if (has(kIsTransmissive)) {
        float transmission = material.layers.w;
        if (has(kHasTransmissionTextures)) transmission *= texture(transmissionMap, uvOf(kTransmissionSlot)).r;
        s.diffuse *= 1.0 - transmission;
        through = transmitted(base.rgb, transmission * (1.0 - metallic));
    }

    vec2 left = vec2(1.0);
    if (has(kHasProbeShadow)) left = leftByProbe(place, n, frame.toLight0.xyz);
    const vec3 specular = specularShare(s, nv);
    vec3 scattered = vec3(0.0);
    if (has(kIsTransmissive)) {
        // What is rough scatters the light from behind instead of showing what is there.
        through *= 1.0 - largest(specular);
        scattered = through * s.alpha * irradianceAt(-v);
        through *= 1.0 - s.alpha;
    }
    const vec3 color = lit(s, specular, n, smoothNormal, v, nv, occlusion, scattered, left);
#ifdef KEPT
    // The light is linear in what is left of each.
    keptFirst = kept(color - lit(s, specular, n, smoothNormal, v, nv, occlusion, scattered, vec2(0.0, 1.0)), n.x);
    keptAround = kept(color - lit(s, specular, n, smoothNormal, v, nv, occlusion, scattered, vec2(1.0, 0.0)), n.y);
    keptTotal = kept(color, n.z);
#endif
    if (has(kIsTransmissive)) writeOver(color, through, alpha);
    else outColor = vec4(toneMapped(color), alpha);
}

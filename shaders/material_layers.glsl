// Layers over a surface: KHR_materials_sheen and KHR_materials_clearcoat; and what shines through it:
// KHR_materials_transmission with KHR_materials_volume. Needs surface_light.glsl, the material and its maps.

float largest(vec3 c) { return max(c.r, max(c.g, c.b)); }

/// The sheen lobe of one light, times cos.
vec3 sheenOf(vec3 color, float alpha, vec3 n, vec3 v, vec3 l, float nv) {
    const float nl = clamp(dot(n, l), 0.0, 1.0), nh = clamp(dot(n, normalize(l + v)), 0.0, 1.0);
    const float inverse = 1.0 / alpha;
    const float distribution = (2.0 + inverse) * pow(max(1.0 - nh * nh, 1e-4), 0.5 * inverse) * 0.15915494; // 1 / 2 pi
    return color * (distribution * nl / (4.0 * (nl + nv - nl * nv) + 1e-4));
}

/// Puts the sheen over `color` and lets what is below have the rest.
vec3 underSheen(vec3 color, vec3 n, vec3 v, float nv, vec2 left) {
    vec3 sheen = material.sheenColorThickness.rgb;
    float roughness = material.layers.z;
    if (has(kHasSheenTextures)) {
        sheen *= texture(sheenColorMap, uvOf(kSheenColorSlot)).rgb;
        roughness *= texture(sheenRoughnessMap, uvOf(kSheenRoughnessSlot)).a;
    }
    roughness = clamp(roughness, 0.1, 1.0);
    const float albedo = sheenAlbedo(nv, roughness), alpha = roughness * roughness;
    vec3 lobe = frame.irradiance0.rgb * (left.x * sheenOf(sheen, alpha, n, v, frame.toLight0.xyz, nv));
    if (has(kHasSecondLight)) lobe += frame.irradiance1.rgb * sheenOf(sheen, alpha, n, v, frame.toLight1.xyz, nv);
    lobe += sheen * (left.y * albedo) * irradianceAt(n);
    return color * (1.0 - largest(sheen) * albedo) + lobe;
}

/// A clear varnish of f0 = 0.04 over `color`, with the normal `n` of the surface itself.
vec3 underCoat(vec3 color, vec3 n, vec3 v, vec2 left) {
    float coat = material.layers.x, roughness = material.layers.y;
    if (has(kHasClearcoatTextures)) {
        coat *= texture(clearcoatMap, uvOf(kClearcoatSlot)).r;
        roughness *= texture(clearcoatRoughnessMap, uvOf(kClearcoatRoughnessSlot)).g;
    }
    roughness = clamp(roughness, 0.06, 1.0);
    const Surface s = Surface(vec3(0.0), vec3(0.04), 1.0, roughness, roughness * roughness, vec3(1.0));
    const float nv = clamp(abs(dot(n, v)), 1e-3, 1.0);
    const float grazing = 1.0 - nv;
    const float fresnel = 0.04 + 0.96 * grazing * grazing * grazing * grazing * grazing;
    vec3 lobe = frame.irradiance0.rgb * (left.x * reflected(s, n, v, frame.toLight0.xyz, nv));
    if (has(kHasSecondLight)) lobe += frame.irradiance1.rgb * reflected(s, n, v, frame.toLight1.xyz, nv);
    const vec2 brdf = environmentBrdf(roughness, nv);
    lobe += left.y * (0.04 * brdf.x + brdf.y) * surroundings(reflect(-v, n), roughness, s.alpha);
    return color * (1.0 - coat * fresnel) + coat * lobe;
}

/// Share of the light behind that comes through, by channel. Nothing is refracted: it is what lies behind on the screen.
/// A volume is passed once, where the line of sight enters it.
vec3 transmitted(vec3 base, float transmission) {
    if (!has(kHasVolume)) return base * transmission;
    if (!gl_FrontFacing) return vec3(transmission);
    float thickness = material.sheenColorThickness.w * object.normalFromMesh[1].w;
    if (has(kHasTransmissionTextures)) thickness *= texture(thicknessMap, uvOf(kThicknessSlot)).g;
    return base * transmission * exp2(-material.absorption.rgb * thickness);
}

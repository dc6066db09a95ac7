// The light that reaches a surface, and the lobes that reflect it. Needs `frame`, `environmentMap` and `has`.
#include "shared/closed_forms.h"

/// What the core lobes need of a surface.
struct Surface {
    vec3 diffuse;
    vec3 f0;
    float f90;
    float roughness, alpha; ///< alpha = roughness^2
    vec3 gain;              ///< what multiple scattering adds to the specular lobe: 1 without it
};

/// Light reflected towards v from one direction, times cos: Lambert and GGX with Hammon's approximation of
/// Smith's joint visibility ("PBR diffuse lighting for GGX + Smith", 2017).
vec3 reflected(Surface s, vec3 n, vec3 v, vec3 l, float nv) {
    const float nl = clamp(dot(n, l), 0.0, 1.0);
    const vec3 h = normalize(l + v);
    const float nh = clamp(dot(n, h), 0.0, 1.0), vh = clamp(dot(v, h), 0.0, 1.0);
    const float a2 = s.alpha * s.alpha;
    const float d = nh * nh * (a2 - 1.0) + 1.0;
    // Visibility is 0.5 / this, and a2 / (pi d^2) the GGX distribution: one division for both.
    const float visibilityDivisor = mix(2.0 * nl * nv, nl + nv, s.alpha);
    const float grazing = 1.0 - vh;
    const float grazing2 = grazing * grazing;
    const vec3 fresnel = (s.f0 + (s.f90 - s.f0) * (grazing2 * grazing2 * grazing)) * s.gain;
    return (s.diffuse + fresnel * (0.5 * a2 / (visibilityDivisor * d * d))) * (nl * 0.31830989); // 1/pi for both
}

/// Irradiance / pi of the surroundings.
vec3 irradianceAt(vec3 n) {
    vec3 squares;
    if (has(kHasEnvironment)) {
        squares = frame.irradianceColor[0].rgb * (n.x * n.y) + frame.irradianceColor[1].rgb * (n.y * n.z) +
                  frame.irradianceColor[2].rgb * (n.z * n.x) + frame.irradianceColor[3].rgb * (n.x * n.x) +
                  frame.irradianceColor[4].rgb * (n.y * n.y);
    } else {
        const vec4 grey = frame.irradianceSquares * vec4(n.x * n.y, n.y * n.z, n.z * n.x, n.x * n.x);
        squares = vec3(grey.x + grey.y + grey.z + grey.w + frame.irradiance[0].w * (n.y * n.y));
    }
    return max(frame.irradiance[0].rgb + frame.irradiance[1].rgb * n.x + frame.irradiance[2].rgb * n.y +
                   frame.irradiance[3].rgb * n.z + squares,
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
    if (has(kHasEnvironment))
        return textureLod(environmentMap, r, roughness * frame.environment.y).rgb * frame.environment.x;
    const float width = 0.06 + 0.94 * roughness;
    const float above = clamp(0.5 + 0.5 * r.y / width, 0.0, 1.0);
    const vec3 sky = mix(frame.rim.rgb - frame.floorFall.rgb * r.y, frame.horizon.rgb + frame.skyRise.rgb * r.y, above);
    const float blur = 2.0 * alpha * alpha;
    return sky + lampAround(r, blur, frame.lampAxis[0], frame.lampRadiance[0].rgb) +
           lampAround(r, blur, frame.lampAxis[1], frame.lampRadiance[1].rgb);
}

/// Integral of the specular lobe over a uniform surrounding, as scale of f0 and bias: the fit of Karis, "Physically
/// based shading on mobile" (2014).
vec2 environmentBrdf(float roughness, float nv) {
    const vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    const float a = min(r.x * r.x, exp2(-9.28 * nv)) * r.x + r.y;
    return vec2(-1.04, 1.04) * a + r.zw;
}

/// Share of uniform surroundings that the specular lobe reflects. With multiple scattering it is 1 for f0 = 1: Karis' fit
/// keeps its bias, and its scale becomes what is missing to the lobe's albedo. Sets s.gain.
vec3 specularShare(inout Surface s, float nv) {
    const vec2 brdf = environmentBrdf(s.roughness, nv);
    if (!has(kIsMetallic)) return s.f0 * brdf.x + s.f90 * brdf.y;
    const float albedo = ggxAlbedo(nv, s.roughness);
    const float bias = clamp(brdf.y, 0.0, albedo);
    s.gain = 1.0 + s.f0 * (1.0 / albedo - 1.0);
    return (s.f0 * (albedo - bias) + s.f90 * bias) * s.gain;
}

// The normal that a surface shows: interpolated, turned to the viewer's side, bent by a normal map.

/// x, y, z of a tangent-space normal map sample, with its scale.
vec3 decodeNormal(vec3 texel, float scale) {
    vec3 n = texel * 2.0 - 1.0;
    n.xy *= scale;
    return n;
}

/// Tangent-space normal `m` with the model's tangents. glTF: bitangent = cross(normal, tangent) * w.
vec3 bendWithTangent(vec3 n, vec4 tangent, vec3 m) {
    const vec3 t = normalize(tangent.xyz);
    return normalize(t * m.x + cross(n, t) * (tangent.w * m.y) + n * m.z);
}

/// The same without tangents: the frame follows from how position and UV change across the pixel (Mikkelsen,
/// "Bump mapping unparametrized surfaces on the GPU", 2010). T = dP/du, and as glTF's V points down, B = -dP/dv.
/// The sign makes it independent of the image's orientation. Degenerate UVs leave the normal as it is.
vec3 bendWithDerivatives(vec3 n, vec3 position, vec2 uv, vec3 m) {
    const vec3 dx = dFdx(position), dy = dFdy(position);
    const vec2 uvDx = dFdx(uv), uvDy = dFdy(uv);
    const vec3 dyPerp = cross(dy, n), dxPerp = cross(n, dx);
    const float orientation = dot(dx, dyPerp) < 0.0 ? -1.0 : 1.0;
    const vec3 t = (dyPerp * uvDx.x + dxPerp * uvDy.x) * orientation;
    const vec3 b = (dyPerp * uvDx.y + dxPerp * uvDy.y) * -orientation;
    const float longest = max(dot(t, t), dot(b, b));
    if (!(longest > 0.0)) return n;
    const float s = inversesqrt(longest);
    return normalize(t * (s * m.x) + b * (s * m.y) + n * m.z);
}

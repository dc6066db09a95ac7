// What a haptic program makes of a pixel (docs/programs.md): read by scene.frag.
layout(location = 6) in vec3 programPosition;
layout(location = 7) in vec3 programNormal;
layout(location = 8) in vec4 programTangent;
layout(set = 2, binding = 1) uniform ProgramObject { ProgramObjectUniforms programObject; };

/// The persistent textures of all instances, row by row.
layout(std430, set = 2, binding = 2) readonly buffer ProgramTexels { float programTexels[]; };

#include "program_host.glsl"

struct Programmed {
    vec3 color;      // linear
    float roughness;
    vec3 bend;       // what is added to the unit normal, eye frame
};

float statedRoughness() {
    if (has(kHasSpecularGlossiness)) {
        float glossiness = material.specularGlossiness.a;
        if (has(kHasSpecularGlossinessTexture))
            glossiness *= texture(specularGlossinessMap, uvOf(kSpecularGlossinessSlot)).a;
        return 1.0 - glossiness;
    }
    float roughness = material.factors.y;
    if (has(kHasMetallicRoughnessTexture)) roughness *= texture(metallicRoughnessMap, uvOf(kMetallicRoughnessSlot)).g;
    return roughness;
}

/// Unit, at right angles to n: along the mesh's tangent, else along u.
vec3 programTangentBeside(vec3 n, vec3 dx, vec3 dy) {
    vec3 t = programTangent.xyz;
    if (!has(kHasTangents)) {
        const vec2 uvDx = dFdx(uvs.xy), uvDy = dFdy(uvs.xy);
        t = cross(dy, n) * uvDx.x + cross(n, dx) * uvDy.x;
        if (dot(dx, cross(dy, n)) < 0.0) t = -t;
    }
    t -= dot(t, n) * n;
    const float square = dot(t, t);
    if (square > 0.0) return t * inversesqrt(square);
    return normalize(abs(n.x) < 0.7 ? vec3(0.0, n.z, -n.y) : vec3(-n.z, 0.0, n.x));
}

/// A normal of the program's frame in the eye frame, unit.
vec3 eyeNormalOf(vec3 normal) {
    const vec3 inMesh = programObject.programFromMesh[0].xyz * normal.x +
                        programObject.programFromMesh[1].xyz * normal.y +
                        programObject.programFromMesh[2].xyz * normal.z;
    return normalize(vec3(dot(object.normalFromMesh[0].xyz, inMesh), dot(object.normalFromMesh[1].xyz, inMesh),
                          dot(object.normalFromMesh[2].xyz, inMesh)));
}

/// The persistent texture, bilinear and repeating, as for the hand.
float persistentAt(vec2 uv) {
    const uvec2 size = programObject.texels.xy;
    if (size.x == 0u) return programObject.persistent.x;
    const vec2 at = (uv - floor(uv)) * vec2(size) - 0.5, corner = floor(at), part = at - corner;
    const ivec2 n = ivec2(size), low = (ivec2(corner) + n) % n, high = (low + 1) % n;
    const int first = int(programObject.texels.z);
    const vec2 upper = vec2(programTexels[first + low.y * n.x + low.x], programTexels[first + low.y * n.x + high.x]);
    const vec2 lower = vec2(programTexels[first + high.y * n.x + low.x], programTexels[first + high.y * n.x + high.x]);
    const vec2 rows = vec2(mix(upper.x, upper.y, part.x), mix(lower.x, lower.y, part.x));
    return mix(rows.x, rows.y, part.y);
}

/// The program runs as if nothing moved: a force of 1 N, no stroke, and the filter width of a pixel. Where it has no
/// result the pixel is plain. A displacement bends the normal by its slope, the difference between neighbouring pixels.
Programmed programmedSurface(vec3 base) {
    const vec3 n = normalize(programNormal), dx = dFdx(programPosition), dy = dFdy(programPosition);
    touchstone_position = programPosition;
    touchstone_normal = n;
    touchstone_tangent = programTangentBeside(n, dx, dy);
    touchstone_binormal = cross(n, touchstone_tangent);
    touchstone_uv = uvs.xy;
    touchstone_toolDirection = touchstone_toolVelocity = touchstone_toolAcceleration = vec3(0.0);
    touchstone_force = n;
    touchstone_material = programObject.material;
    touchstone_tick = vec2(sqrt(max(dot(dx, dx), dot(dy, dy))), 0.0);
    touchstone_look = vec4(base, statedRoughness());
    touchstone_persistent = persistentAt(uvs.xy);
    const bool done = runProgram();
    float height = 0.0;
    if (done) height = dot(touchstone_outPosition - programPosition, n);
    const float heightDx = dFdx(height), heightDy = dFdy(height); // of all pixels of a square
    Programmed result = Programmed(base, touchstone_look.a, vec3(0.0));
    if (!done) return result;
    result.color = clamp(touchstone_outLook.rgb, vec3(0.0), vec3(1.0));
    result.roughness = clamp(touchstone_outLook.a, 0.0, 1.0);
    vec3 bent = touchstone_outNormal;
    if (bent == n) {
        const vec3 alongX = cross(dy, n), alongY = cross(n, dx);
        const float area = dot(dx, alongX);
        if (abs(area) > 0.0) bent = n - (alongX * heightDx + alongY * heightDy) / area;
    }
    if (dot(bent, bent) > 0.0) result.bend = eyeNormalOf(bent) - eyeNormalOf(n);
    return result;
}

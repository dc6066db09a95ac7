// Functions for haptic programs besides those of GLSL (docs/programs.md). Read before every program.
//
// Noise is gradient noise (Perlin 1985) with the fade of 2002, twice continuously differentiable. The gradients
// come from an integer hash (PCG, Jarzynski and Olano 2020), which every processor computes alike. Wavelengths are
// about 1: multiply the place by a frequency.

uint hash(uint x) {
    uint state = x * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}
uvec2 hash(uvec2 x) {
    uvec2 state = x * 747796405u + 2891336453u;
    uvec2 word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}
uvec4 hash(uvec4 x) {
    uvec4 state = x * 747796405u + 2891336453u;
    uvec4 word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// A number of -1 to 1 out of ten bits of each hash.
vec4 touchstone_slope(uvec4 bits, uint shift) {
    return vec4((bits >> shift) & 1023u) * (2.0 / 1023.0) - 1.0;
}
vec2 touchstone_slope(uvec2 bits) {
    return vec2(bits & 1023u) * (2.0 / 1023.0) - 1.0;
}
float touchstone_fade(float t) {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}
vec2 touchstone_fade(vec2 t) {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}
vec3 touchstone_fade(vec3 t) {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

// Noise of -1 to 1, 0 at integers.
float noise(float p) {
    float cell = floor(p);
    float f = p - cell;
    uint i = uint(int(cell));
    vec2 value = touchstone_slope(hash(uvec2(i, i + 1u))) * vec2(f, f - 1.0);
    return 2.0 * mix(value.x, value.y, touchstone_fade(f));
}
float noise(vec2 p) {
    vec2 cell = floor(p);
    vec2 f = p - cell;
    uvec2 i = uvec2(ivec2(cell));
    uvec2 row = hash(uvec2(i.y, i.y + 1u));
    uvec4 corner = hash(uvec4(i.x, i.x + 1u, i.x, i.x + 1u) + row.xxyy);
    vec4 value = touchstone_slope(corner, 0u) * vec4(f.x, f.x - 1.0, f.x, f.x - 1.0) +
                 touchstone_slope(corner, 10u) * vec4(f.y, f.y, f.y - 1.0, f.y - 1.0);
    vec2 w = touchstone_fade(f);
    vec2 along = mix(value.xz, value.yw, w.x);
    return mix(along.x, along.y, w.y);
}
float noise(vec3 p) {
    vec3 cell = floor(p);
    vec3 f = p - cell;
    uvec3 i = uvec3(ivec3(cell));
    uvec2 layer = hash(uvec2(i.z, i.z + 1u));
    uvec4 row = hash(uvec4(i.y, i.y + 1u, i.y, i.y + 1u) + layer.xxyy);
    uvec4 near = hash(row + i.x), far = hash(row + (i.x + 1u)); // y in xz and yw, z in xy and zw
    vec4 y = vec4(f.y, f.y - 1.0, f.y, f.y - 1.0), z = vec4(f.z, f.z, f.z - 1.0, f.z - 1.0);
    vec4 value0 = touchstone_slope(near, 0u) * f.x + touchstone_slope(near, 10u) * y + touchstone_slope(near, 20u) * z;
    vec4 value1 =
        touchstone_slope(far, 0u) * (f.x - 1.0) + touchstone_slope(far, 10u) * y + touchstone_slope(far, 20u) * z;
    vec3 w = touchstone_fade(f);
    vec4 face = mix(value0, value1, w.x);
    vec2 along = mix(face.xz, face.yw, w.y);
    return (2.0 / 3.0) * mix(along.x, along.y, w.z);
}
// Three noises of one place.
vec3 noise3(vec3 p) {
    return vec3(noise(p), noise(p + vec3(37.0, 17.0, 59.0)), noise(p + vec3(-23.0, 71.0, 11.0)));
}

// The part of a wave of length 1 that sampling every `width` still shows: 1 below a fifth, 0 from 0.4 on.
// Noise has shorter waves, too: an end at half would leave them in.
float kept(float width) {
    return 1.0 - smoothstep(0.2, 0.4, width);
}
// Noise without what sampling every `width` cannot show; `width` in the units of p.
float filteredNoise(float p, float width) {
    return kept(width) * noise(p);
}
float filteredNoise(vec2 p, float width) {
    return kept(width) * noise(p);
}
float filteredNoise(vec3 p, float width) {
    return kept(width) * noise(p);
}

// Octaves of noise, each of twice the frequency and `gain` times the amplitude.
float fBm(vec3 p, int octaves, float gain) {
    float sum = 0.0, amplitude = 1.0;
    for (int i = 0; i < octaves; i++) {
        sum += amplitude * noise(p);
        p *= 2.0;
        amplitude *= gain;
    }
    return sum;
}
// The same without the octaves that sampling every `width` cannot show.
float filteredFBm(vec3 p, int octaves, float gain, float width) {
    float sum = 0.0, amplitude = 1.0;
    for (int i = 0; i < octaves && width < 0.4; i++) {
        sum += amplitude * filteredNoise(p, width);
        p *= 2.0;
        amplitude *= gain;
        width *= 2.0;
    }
    return sum;
}

// Distance to the nearest of the points strewn one into each cell (Worley 1996).
float cellular(vec3 p) {
    vec3 cell = floor(p);
    ivec3 i = ivec3(cell);
    vec3 f = p - cell;
    float nearest = 4.0;
    for (int z = -1; z <= 1; z++)
        for (int y = -1; y <= 1; y++)
            for (int x = -1; x <= 1; x++) {
                uint bits = hash(uint(i.x + x) + hash(uint(i.y + y) + hash(uint(i.z + z))));
                vec3 strewn = vec3(bits & 1023u, (bits >> 10u) & 1023u, (bits >> 20u) & 1023u) * (1.0 / 1023.0);
                vec3 offset = vec3(x, y, z) + strewn - f;
                nearest = min(nearest, dot(offset, offset));
            }
    return sqrt(nearest);
}

// Brushed metal: scratches in one direction. Along them it is slippery to and fro, across them it holds.
parameter vec3 grain = vec3(1, 0, 0); // -1..1 : direction of the scratches; its length does not count
parameter float alongStatic = 0.08; // 0..2 : static friction along the scratches
parameter float acrossStatic = 0.45; // 0..2 : static friction across them
parameter float scratches = 900; // 10..20000 1/m: scratches per metre
parameter float depth = 0.00004; // 0..0.001 m: of the scratches, to either side

void touch(const in Touch before, inout Surface after) {
    vec3 axis = normalize(grain + vec3(1e-9, 0, 0));
    vec3 across = cross(before.normal, axis);
    float share = abs(dot(axis, before.toolDirection));
    after.staticFriction = mix(acrossStatic, alongStatic, share);
    after.dynamicFriction = 0.8 * after.staticFriction;
    float place = dot(before.position, across) * scratches;
    float width = before.filterWidth * scratches * (1.0 - share);
    after.position = before.position + depth * filteredNoise(place, width) * before.normal;
}

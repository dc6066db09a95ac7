// Wet ice: at rest it holds a little, and the faster the tool slides the more water lies under it.
parameter float restStatic = 0.12; // 0..2 : static friction at rest
parameter float wetDynamic = 0.01; // 0..2 : dynamic friction on the water
parameter float speed = 0.08; // 0.001..1 m/s: from which it floats
parameter float water = 0.8; // 0..10 N s/m: damping of the water
parameter float uneven = 0.0006; // 0..0.01 m: how far the ice waves, to either side
parameter float waves = 30; // 1..1000 1/m: waves per metre

void touch(const in Touch before, inout Surface after) {
    float sliding = length(before.toolVelocity - dot(before.toolVelocity, before.normal) * before.normal);
    float wet = smoothstep(0.0, speed, sliding);
    after.staticFriction = mix(restStatic, wetDynamic, wet);
    after.dynamicFriction = mix(0.6 * restStatic, wetDynamic, wet);
    after.damping = before.damping + water * wet;
    float wave = filteredNoise(before.position * waves, before.filterWidth * waves);
    after.position = before.position + uneven * wave * before.normal;
}

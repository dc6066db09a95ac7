// Plaque on a tooth ([003], dentistry application): touch wears it off where it presses, and the enamel below is smooth.
parameter float rate = 0.0002; // 0..0.01 m^2/(N s): area that a force of 1 N cleans in a second
parameter float brushRadius = 0.004; // 0.0005..0.02 m: radius of the tool's tip
parameter vec2 enamelFriction = vec2(0.08, 0.05); // 0..2 : static and dynamic friction of the clean tooth
parameter vec2 plaqueFriction = vec2(0.7, 0.5); // 0..2 : of plaque
parameter vec3 enamelColour = vec3(0.80, 0.76, 0.66); // 0..1 : linear
parameter vec3 plaqueColour = vec3(0.50, 0.30, 0.06); // 0..1 : linear

void touch(const in Touch before, inout Surface after) {
    float cover = before.persistent;
    vec2 friction = mix(enamelFriction, plaqueFriction, cover);
    after.staticFriction = friction.x;
    after.dynamicFriction = friction.y;
    after.persistentChange = -rate * length(before.force);
    after.brush = brushRadius;
    float stain = 0.75 + 0.25 * filteredNoise(before.position * 300.0, before.filterWidth * 300.0);
    after.colour = mix(enamelColour, plaqueColour * stain, cover);
    after.roughness = mix(0.15, 0.9, cover);
}

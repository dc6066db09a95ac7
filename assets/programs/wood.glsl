// Wood: rings of two frictions ([003] Figures 4 and 5, one source for both; noise of one and of three dimensions).
parameter float ringscale = 200; // 1..2000 1/m: rings per metre
parameter float grain = 0.005; // 0..0.1 m: how far the rings wander
parameter float knots = 40; // 0..400 1/m: how often they do
parameter float lightStatic = 0.02; // 0..2 : static friction of light wood
parameter float lightDynamic = 0.02; // 0..2 : dynamic friction of light wood
parameter float darkStatic = 0.5; // 0..2 : static friction of dark wood
parameter float darkDynamic = 0.5; // 0..2 : dynamic friction of dark wood
parameter float edge = 0.15; // 0..0.5 : part of a ring in which dark becomes light again; 0: at once, as in the paper
parameter vec3 lightColour = vec3(0.3, 0.12, 0.03); // 0..1 : colour of light wood, linear
parameter vec3 darkColour = vec3(0.05, 0.01, 0.005); // 0..1 : colour of dark wood

void touch(const in Touch before, inout Surface after) {
    vec3 p = before.position + grain * noise(before.position * knots);
    float r = length(p.yz) * ringscale;
    r += abs(noise(r));
    r -= floor(r);
    // The paper's ring is a sawtooth, whose friction falls from dark to light within a tick.
    r = r > 1.0 - edge ? (1.0 - r) / edge : r / (1.0 - edge);
    after.staticFriction = mix(lightStatic, darkStatic, r);
    after.dynamicFriction = mix(lightDynamic, darkDynamic, r);
    after.colour = mix(lightColour, darkColour, r);
    after.roughness = mix(0.5, 0.35, r);
}

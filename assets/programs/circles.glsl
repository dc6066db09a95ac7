// Circles: three raised rings of metal let into a rough surface ([003] Figure 10).
parameter vec3 c1 = vec3(-0.03, 0, 0); // -10..10 m: centre of the first ring
parameter vec3 c2 = vec3(0, 0, 0); // -10..10 m: centre of the second ring
parameter vec3 c3 = vec3(0.03, 0, 0); // -10..10 m: centre of the third ring
parameter float innerRadius = 0.006; // 0..10 m
parameter float outerRadius = 0.012; // 0..10 m
parameter float raised = 1.4; // 1..3 : force on a ring by the force beside it
parameter float ringStatic = 0.02; // 0..2 : static friction on a ring
parameter float roughStatic = 0.25; // 0..2 : static friction beside it
parameter float edge = 0.0005; // 0..0.01 m: width of a ring's rims; 0: a step of the force, as in the paper
parameter vec3 ringColour = vec3(0.7, 0.6, 0.35); // 0..1 : colour of the rings, linear

// 1 on a ring, 0 beside it.
float ring(float d) {
    if (edge <= 0.0)
        return d < outerRadius && d > innerRadius ? 1.0 : 0.0;
    return smoothstep(innerRadius - edge / 2.0, innerRadius + edge / 2.0, d) *
           (1.0 - smoothstep(outerRadius - edge / 2.0, outerRadius + edge / 2.0, d));
}

void touch(const in Touch before, inout Surface after) {
    vec3 p = before.position;
    float on = max(max(ring(distance(c1, p)), ring(distance(c2, p))), ring(distance(c3, p)));
    after.staticFriction = mix(roughStatic, ringStatic, on);
    after.dynamicFriction = min(before.dynamicFriction, after.staticFriction);
    after.force = before.force * mix(1.0, raised, on);
    after.colour = mix(after.colour, ringColour, on);
    after.roughness = mix(0.9, 0.2, on);
}

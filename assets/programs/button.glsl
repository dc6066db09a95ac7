// A button that clicks: in its disc the force grows, gives way at the click, and grows again.
parameter vec3 centre = vec3(0, 0, 0); // -10..10 m: of the disc
parameter float radius = 0.012; // 0.001..10 m
parameter float rim = 0.002; // 0..0.05 m: width over which the click fades out
parameter float press = 0.002; // 0.0001..0.02 m: depth at which it clicks
parameter float travel = 0.0006; // 0.0001..0.01 m: over which it gives way
parameter float drop = 0.6; // 0..1 : part of the force that it loses

void touch(const in Touch before, inout Surface after) {
    float d = length(before.force) / before.stiffness;
    vec3 beside = before.position - centre;
    beside -= dot(beside, before.normal) * before.normal;
    float on = 1.0 - smoothstep(radius - rim, radius, length(beside));
    float lost = drop * press * smoothstep(press, press + travel, d);
    after.force = before.force * (1.0 - on * lost / max(d, 1e-6));
}

// Fabric: threads that pass over and under each other in the x-y plane, soft and damped.
parameter float thread = 0.002; // 0.0002..0.02 m: width of a thread
parameter float height = 0.0003; // 0..0.003 m: of a crossing above a hole
parameter float softness = 0.4; // 0.05..1 : stiffness by that of the material
parameter float friction = 0.5; // 0..2 : static friction in the middle of a thread
parameter float fuzz = 1.5; // 0..10 N s/m: damping

const float kHalfTurn = 3.14159265359;

void touch(const in Touch before, inout Surface after) {
    vec2 p = before.position.xy * kHalfTurn / thread;
    float weave = sin(p.x) * sin(p.y); // above 0: the warp is on top, below: the weft
    float wave = kept(0.5 * before.filterWidth / thread);
    after.position = before.position + wave * height * weave * weave * before.normal;
    after.staticFriction = friction * (0.7 + 0.3 * abs(weave));
    after.dynamicFriction = 0.9 * after.staticFriction;
    after.stiffness = softness * before.stiffness;
    after.damping = before.damping + fuzz;
}

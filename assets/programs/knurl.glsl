// Knurl: two rows of grooves across each other in the x-y plane, as a lathe rolls them into a handle.
parameter float pitch = 0.003; // 0.0002..0.05 m: from groove to groove
parameter float depth = 0.0004; // 0..0.005 m: of the grooves below the ridges' crossings
parameter float friction = 0.25; // 0..2 : static friction of the metal

const float kTurn = 6.28318530718;

void touch(const in Touch before, inout Surface after) {
    vec2 across = vec2(before.position.x + before.position.y, before.position.x - before.position.y) * sqrt(0.5) / pitch;
    vec2 ridge = 0.5 + 0.5 * cos(kTurn * across);
    float wave = kept(before.filterWidth / pitch);
    after.position = before.position + wave * depth * (ridge.x * ridge.y - 0.25) * before.normal;
    after.staticFriction = friction;
    after.dynamicFriction = 0.8 * friction;
}

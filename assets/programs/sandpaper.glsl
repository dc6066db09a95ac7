// Sandpaper: grains glued to a rough ground.
parameter float grit = 1200; // 100..20000 1/m: grains per metre
parameter float height = 0.0002; // 0..0.002 m: of the grains, to either side
parameter float friction = 0.7; // 0..2 : static friction of the grains
parameter float sliding = 0.8; // 0..1 : dynamic friction by the static one

void touch(const in Touch before, inout Surface after) {
    float grains = filteredFBm(before.position * grit, 2, 0.5, before.filterWidth * grit);
    after.position = before.position + height * grains * before.normal;
    after.staticFriction = friction;
    after.dynamicFriction = sliding * friction;
}

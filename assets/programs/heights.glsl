// Heights in space, h(x, y, z), on any model: no texture coordinates are needed. The hand feels its gradient.
parameter float waves = 60; // 1..5000 1/m: waves per metre
parameter float height = 0.0006; // 0..0.01 m: to either side
parameter int kind = 0; // 0..2 : 0: waves along x, y and z; 1: cells; 2: noise

const float kTurn = 6.28318530718;

void touch(const in Touch before, inout Surface after) {
    vec3 p = before.position * waves;
    float width = before.filterWidth * waves;
    float h;
    if (kind == 0)
        h = kept(width) * (sin(kTurn * p.x) + sin(kTurn * p.y) + sin(kTurn * p.z)) / 3.0;
    else if (kind == 1)
        h = kept(width) * (cellular(p) - 0.5);
    else
        h = filteredNoise(p, width);
    after.position = before.position + height * h * before.normal;
}

// SimpleNoise: the force swells and shrinks ([003] Figure 7).
parameter float domain = 400; // 1..10000 1/m: waves per metre of the coarsest octave
parameter float range = 0.5; // 0..1 : swell of the coarsest octave
parameter int octaves = 3; // 1..8 : each twice as fine and half as strong
parameter int filtered = 1; // 0..1 : 1: without the waves that a stroke would alias

void touch(const in Touch before, inout Surface after) {
    float u = 0.0, freq = 1.0;
    for (int i = 0; i < octaves; i++) {
        vec3 p = before.position * domain * freq;
        float width = before.filterWidth * domain * freq;
        u += (filtered != 0 ? filteredNoise(p, width) : noise(p)) * range / freq;
        freq *= 2.0;
    }
    // The paper's force pulls where u < -1, which a range above 4/7 allows: the octaves add up to 7/4 of it.
    after.force = before.force * max(1.0 + u, 0.0);
    after.colour *= clamp(0.7 + 0.5 * u, 0.0, 1.0); // darker where it gives way
}

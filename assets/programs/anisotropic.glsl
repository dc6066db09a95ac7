// Anisotropic: friction by the direction of the stroke ([003] Figure 8).
parameter vec3 textureDir = vec3(1, 0, 0); // -1..1 : direction of the greatest friction; its length does not count
parameter float minStatic = 0.1; // 0..2 : least static friction
parameter float maxStatic = 0.8; // 0..2 : greatest static friction
parameter int axial = 1; // 0..1 : 1: alike to and fro, like brushed metal; 0: least against the direction, as in the paper

void touch(const in Touch before, inout Surface after) {
    // At rest toolDirection is that of the last motion; before any it is 0.
    float along = dot(textureDir, before.toolDirection) / max(length(textureDir), 1e-6);
    float share = axial != 0 ? abs(along) : along / 2.0 + 0.5;
    after.staticFriction = mix(minStatic, maxStatic, clamp(share, 0.0, 1.0));
    // The paper leaves the dynamic friction, which may be above the static one then.
    after.dynamicFriction = min(before.dynamicFriction, after.staticFriction);
}

// The probe's shadow. Needs `frame`.

/// What the probe leaves of the first light (x) and of the surroundings (y) at `position` (eye frame) with normal n;
/// lengths in its radii. The shadow widens with the distance along the light and fades as the ball covers less of it; of
/// the surroundings a ball hides cos(angle) (radius / distance)^2. renderer/shadow_area.cpp bounds where both are seen.
vec2 leftByProbe(vec3 position, vec3 n, vec3 l) {
    const vec3 away = (frame.probe.xyz - position) * frame.probe.w;
    const float along = dot(away, l), distance2 = dot(away, away);
    const float width = 1.25 + 0.13 * max(along, 0.0);
    const float cover = 1.0 / (width * width);
    const float inside = max(0.0, 1.0 - max(distance2 - along * along, 0.0) * cover);
    const float shadow = along > -1.0 ? min(1.0, 2.2 * inside) * min(1.0, 1.5 * cover) : 0.0;
    const float nearness = inversesqrt(max(distance2, 1.0));
    return vec2(1.0 - 0.9 * shadow, 1.0 - max(dot(n, away), 0.0) * nearness * nearness * nearness);
}

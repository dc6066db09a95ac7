/// Khronos' PBR Neutral tone mapper (2024): colours below 0.76 stay what they are, brighter ones are compressed
/// and lose saturation.
vec3 compressed(vec3 color) {
    const float start = 0.8 - 0.04, desaturation = 0.15;
    const float peak = max(color.r, max(color.g, color.b));
    if (peak < start) return color;
    const float range = 1.0 - start;
    const float newPeak = 1.0 - range * range / (peak + range - start);
    color *= newPeak / peak;
    const float fade = 1.0 / (desaturation * (peak - newPeak) + 1.0);
    return mix(vec3(newPeak), color, fade);
}

/// The same with its toe, which takes what a dielectric reflects off the smallest channel.
vec3 toneMapped(vec3 color) {
    const float low = min(color.r, min(color.g, color.b));
    const float offset = low < 0.08 ? low - 6.25 * low * low : 0.04;
    return compressed(color - offset);
}

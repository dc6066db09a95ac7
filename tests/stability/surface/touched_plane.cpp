#include "tests/stability/surface/touched_plane.h"

#include <algorithm>
#include <cmath>

namespace touchstone::test {

HapticSettings felt(TextureMode mode, double radius) {
    HapticSettings s = Variant{radius, true}.settings();
    s.texture = mode;
    return s;
}

Scene reliefPlane(const Image& heights, double scale, int cells) {
    Scene scene;
    scene.materials.emplace_back();
    scene.images.push_back(heights);
    HeightMap map;
    map.texture = texture(0);
    map.scale = static_cast<float>(scale);
    scene.materials[0].haptic.height = {map, HapticSource::Touchstone};
    place(scene, quadMesh(0.5 * kSide, cells), 0);
    return scene;
}

Image slopeImage(int texels) {
    return image("slope", texels, texels, 1,
                 [](double u, double) { return glm::vec4(static_cast<float>(u)); });
}

Image cliffImage(int texels) {
    return image("cliffs", texels, texels, 1, [texels](double u, double v) {
        const int x = static_cast<int>(u * texels), y = static_cast<int>(v * texels);
        return glm::vec4(static_cast<float>((x + y) % 2));
    });
}

double cliffValue(int texels, double u, double v) {
    const double x = u * texels - 0.5, y = v * texels - 0.5;
    const auto at = [](double i, double j) { return std::fmod(std::abs(i + j), 2.0); };
    const double x0 = std::floor(x), y0 = std::floor(y), wx = x - x0, wy = y - y0;
    return (1.0 - wy) * ((1.0 - wx) * at(x0, y0) + wx * at(x0 + 1.0, y0)) +
           wy * ((1.0 - wx) * at(x0, y0 + 1.0) + wx * at(x0 + 1.0, y0 + 1.0));
}

glm::dvec2 uvOn(const glm::dvec3& place) {
    return {0.5 + place.x / kSide, 0.5 - place.y / kSide};
}

void Watch::take(const HapticOutput& out, double allowed) {
    ASSERT_TRUE(std::isfinite(out.force.x + out.force.y + out.force.z));
    ++ticks;
    compressed += has(out.flags, TickFlag::TiltCompressed) ? 1 : 0;
    const double d = out.penetration, cap = bench.settings.textureTiltLimit;
    const double longest = bench.settings.texture == TextureMode::Minsky ? d / std::cos(cap) : d;
    EXPECT_LE(glm::length(out.force), kStiffness * longest * (1.0 + 1e-9) + 1e-12);
    if (!first) {
        const double change = glm::length(out.force - last.force);
        largest = std::max(largest, change);
        worst = std::max(worst, change / allowed);
        EXPECT_LE(change, allowed) << "tick " << ticks;
    }
    first = false;
    last = out;
}

double held(TouchBench& bench) {
    for (int i = 0; i < 300; ++i) // the filtered speed falls, and with it the mip level
        bench.step(bench.output.hip);
    return holdStill(bench, 100);
}

} // namespace touchstone::test

// All supported appearances on spheres in rows, as a visual test of the renderer.

#include "assets/glb_writer.h"
#include "assets/scenes.h"

#include <cmath>
#include <numbers>
#include <tuple>

namespace touchstone::assets {

namespace {

constexpr int kBallsAcross = 6;
constexpr double kPitch = 0.030, kBallRadius = 0.012; // m

Json colored(const char* name, double red, double green, double blue, double metallic, double roughness) {
    return {{"name", name},
            {"pbrMetallicRoughness",
             {{"baseColorFactor", {red, green, blue, 1.0}},
              {"metallicFactor", metallic},
              {"roughnessFactor", roughness}}}};
}

Json with(Json material, const char* extension, Json fields) {
    material["extensions"][extension] = std::move(fields);
    return material;
}

Json glossy(const char* name, const Json& diffuse, const Json& specular, double glossiness) {
    return with({{"name", name}}, "KHR_materials_pbrSpecularGlossiness",
                {{"diffuseFactor", diffuse}, {"specularFactor", specular}, {"glossinessFactor", glossiness}});
}

Json glass(const char* name, double red, double green, double blue, double roughness) {
    return with(colored(name, red, green, blue, 0.0, roughness), "KHR_materials_transmission",
                {{"transmissionFactor", 1.0}});
}

/// Clear glass whose colour comes from absorption.
Json tinted(const char* name, const Json& color) {
    return with(glass(name, 1.0, 1.0, 1.0, 0.0), "KHR_materials_volume",
                {{"thicknessFactor", 2.0 * kBallRadius},
                 {"attenuationDistance", kBallRadius},
                 {"attenuationColor", color}});
}

Json varnished(Json material) {
    return with(std::move(material), "KHR_materials_clearcoat",
                {{"clearcoatFactor", 1.0}, {"clearcoatRoughnessFactor", 0.03}});
}

Json velvet(const char* name, const Json& color, double red, double green, double blue) {
    return with(colored(name, red, green, blue, 0.0, 0.9), "KHR_materials_sheen",
                {{"sheenColorFactor", color}, {"sheenRoughnessFactor", 0.4}});
}

Json glowing() {
    Json lamp = colored("lamp", 0.05, 0.05, 0.05, 0.0, 0.5);
    lamp["emissiveFactor"] = {0.9, 0.5, 0.1};
    return with(lamp, "KHR_materials_emissive_strength", {{"emissiveStrength", 1.5}});
}

/// From the top, left to right.
std::vector<Json> spheres() {
    std::vector<Json> all;
    for (const auto& [name, red, green, blue, metallic] : {std::tuple{"white plastic", 1.0, 1.0, 1.0, 0.0},
                                                           {"white metal", 1.0, 1.0, 1.0, 1.0},
                                                           {"gold", 1.0, 0.72, 0.32, 1.0}})
        for (int i = 0; i < kBallsAcross; ++i)
            all.push_back(colored(name, red, green, blue, metallic, i / (kBallsAcross - 1.0)));
    all.push_back(glass("clear glass", 1.0, 1.0, 1.0, 0.0));
    all.push_back(glass("red glass", 0.9, 0.12, 0.08, 0.0));
    all.push_back(glass("green glass", 0.15, 0.75, 0.25, 0.0));
    all.push_back(tinted("amber", {1.0, 0.55, 0.10}));
    all.push_back(tinted("sapphire", {0.15, 0.30, 0.95}));
    all.push_back(glass("frosted glass", 0.55, 0.80, 0.95, 0.7));
    all.push_back(velvet("velvet", {0.9, 0.08, 0.10}, 0.10, 0.0, 0.01));
    all.push_back(velvet("blue cloth", {0.8, 0.8, 0.9}, 0.05, 0.10, 0.40));
    all.push_back(varnished(colored("varnished paint", 0.5, 0.02, 0.02, 0.0, 0.8)));
    all.push_back(glossy("glossy gold", {0.0, 0.0, 0.0, 1.0}, {1.0, 0.72, 0.32}, 0.8));
    all.push_back(glossy("glossy blue", {0.05, 0.20, 0.70, 1.0}, {0.04, 0.04, 0.04}, 0.7));
    all.push_back(with(colored("diamond", 0.5, 0.5, 0.5, 0.0, 0.1), "KHR_materials_ior", {{"ior", 2.42}}));
    all.push_back({{"name", "glTF's default"}});
    all.push_back(with(colored("unlit", 1.0, 0.35, 0.0, 0.0, 1.0), "KHR_materials_unlit", Json::object()));
    all.push_back(glowing());
    return all;
}

struct Strokes {
    std::vector<glm::vec3> positions, colors;
    void add(const glm::dvec3& position, const glm::dvec3& color) {
        positions.emplace_back(position);
        colors.emplace_back(color);
    }
};

/// A helix with changing colours.
Strokes helix() {
    Strokes strokes;
    for (int i = 0; i <= 120; ++i) {
        const double t = i / 120.0, turn = 10.0 * std::numbers::pi * t;
        strokes.add(
            {kBallRadius * std::cos(turn), kBallRadius * (2.0 * t - 1.0), kBallRadius * std::sin(turn)},
            {1.0 - t, 0.2 + 0.6 * t, t});
    }
    return strokes;
}

/// The twelve edges of a cube, as segments.
Strokes cube() {
    Strokes strokes;
    const double h = 0.8 * kBallRadius;
    for (int axis = 0; axis < 3; ++axis)
        for (int corner = 0; corner < 4; ++corner)
            for (const double end : {-h, h}) {
                glm::dvec3 p(0.0);
                p[axis] = end;
                p[(axis + 1) % 3] = (corner & 1) != 0 ? h : -h;
                p[(axis + 2) % 3] = (corner & 2) != 0 ? h : -h;
                strokes.add(p, {0.95, 0.85, 0.30});
            }
    return strokes;
}

/// Points on a sphere, evenly along a spiral.
Strokes cloud() {
    Strokes strokes;
    for (int i = 0; i < 200; ++i) {
        const double y = 1.0 - 2.0 * (i + 0.5) / 200.0, across = std::sqrt(1.0 - y * y);
        const double turn = std::numbers::pi * (3.0 - std::sqrt(5.0)) * i;
        const glm::dvec3 n(across * std::cos(turn), y, across * std::sin(turn));
        strokes.add(kBallRadius * n, 0.5 + 0.5 * n);
    }
    return strokes;
}

} // namespace

SceneFile materials() {
    GlbWriter glb("materials");
    glb.describe("every look that Touchstone draws, on spheres, lines and points");
    const std::vector<Json> looks = spheres();
    const int rows = static_cast<int>(looks.size() + 3) / kBallsAcross;
    const auto at = [&](size_t i) {
        const int column = static_cast<int>(i) % kBallsAcross, row = static_cast<int>(i) / kBallsAcross;
        return glm::dvec3(kPitch * (column - 0.5 * (kBallsAcross - 1)), kPitch * (0.5 * (rows - 1) - row),
                          0.0);
    };
    int ball = -1;
    for (size_t i = 0; i < looks.size(); ++i) {
        const std::string name = looks[i]["name"];
        const int material = glb.addMaterial(looks[i]);
        ball = ball < 0 ? glb.addMesh(name, sphere(kBallRadius, 24, 48), material)
                        : glb.addMeshLike(name, ball, material);
        glb.addNode(name, ball, at(i));
    }
    const int white = glb.addMaterial(colored("strokes", 1.0, 1.0, 1.0, 0.0, 1.0));
    const auto draw = [&](const char* name, int mode, const Strokes& strokes, size_t place) {
        glb.addNode(name, glb.addStrokes(name, mode, strokes.positions, strokes.colors, white), at(place));
    };
    draw("line strip", 3, helix(), looks.size());
    draw("line segments", 1, cube(), looks.size() + 1);
    draw("points", 0, cloud(), looks.size() + 2);
    const glm::dvec3 sides(kPitch * kBallsAcross + 0.01, kPitch * rows + 0.01, 0.004);
    glb.addNode("plate",
                glb.addMesh("plate", box(sides), glb.addMaterial(colored("plate", 0.6, 0.6, 0.58, 0.0, 0.8))),
                {0.0, 0.0, -0.018});
    return {"materials.glb", glb.finish()};
}

} // namespace touchstone::assets

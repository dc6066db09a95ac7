#include "assets/glb_writer.h"
#include "assets/scenes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace touchstone::assets {

namespace {

const glm::dvec3 kPlate{0.17, 0.006, 0.09};                       // m
const glm::dvec3 kStalk{-0.04, 0.0, 0.0}, kBall{0.045, 0.0, 0.0}; // m, centres
constexpr double kPlateY = -0.066;                                // m, centre
constexpr double kThick = 0.018, kLong = 0.058;                   // m, half axes of the stalk
constexpr double kBallRadius = 0.026;                             // m
const glm::dvec3 kSwollen{1.35, 0.80, 1.35};                      // the ball's axes when it has breathed in
constexpr std::array<double, 3> kJoints{-0.058, -0.018, 0.018};   // m, heights of the joints
constexpr float kBend = 0.7f;                                     // rad, of each upper joint

Json paint(const char* name, std::array<double, 3> color, double roughness, double friction) {
    Json material{{"name", name},
                  {"pbrMetallicRoughness",
                   {{"baseColorFactor", {color[0], color[1], color[2], 1.0}},
                    {"metallicFactor", 0.0},
                    {"roughnessFactor", roughness}}}};
    material["extensions"]["TOUCHSTONE_materials_haptic"] = {{"staticFriction", friction},
                                                             {"dynamicFriction", 0.8 * friction}};
    return material;
}

/// A sphere with other half axes: normals are those of the ellipsoid.
Shape ellipsoid(const Shape& unit, const glm::dvec3& axes) {
    Shape shape = unit;
    for (glm::vec3& p : shape.positions)
        p = glm::vec3(glm::dvec3(p) * axes);
    for (glm::vec3& n : shape.normals)
        n = glm::vec3(glm::normalize(glm::dvec3(n) / axes));
    return shape;
}

/// Two joints a vertex: the mean of those that it lies between.
GlbWriter::Influences influencesOf(const Shape& shape) {
    GlbWriter::Influences influences;
    for (const glm::vec3& p : shape.positions) {
        const double y = p.y;
        // The bend spreads over 12 mm below and above a joint.
        const auto follows = [&](double joint) {
            const double t = std::clamp((y - joint + 0.012) / 0.024, 0.0, 1.0);
            return t * t * (3.0 - 2.0 * t);
        };
        const double second = follows(kJoints[1]), third = follows(kJoints[2]);
        influences.joints.push_back({0, 1, 2, 0});
        influences.weights.push_back(glm::vec4(glm::dvec4(1.0 - second, second - third, third, 0.0)));
    }
    return influences;
}

std::vector<float> turnsAboutZ(const std::vector<float>& angles) {
    std::vector<float> values;
    for (const float angle : angles)
        values.insert(values.end(),
                      {0.0f, 0.0f, static_cast<float>(std::sin(0.5 * static_cast<double>(angle))),
                       static_cast<float>(std::cos(0.5 * static_cast<double>(angle)))});
    return values;
}

} // namespace

SceneFile breathing() {
    GlbWriter glb("breathing");
    glb.describe("a stalk that bends (skin) and a ball that breathes (morph target)");
    const int plate =
        glb.addMesh("plate", box(kPlate), glb.addMaterial(paint("slate", {0.40, 0.47, 0.53}, 0.5, 0.3)));
    glb.addNode("plate", plate, {0.0, kPlateY, 0.0});

    const Shape stalk = ellipsoid(sphere(1.0, 31, 24), {kThick, kLong, kThick});
    const int stalkMesh = glb.addSkinnedMesh("stalk", stalk, influencesOf(stalk),
                                             glb.addMaterial(paint("fern", {0.25, 0.55, 0.22}, 0.6, 0.4)));
    const int stalkNode = glb.addNode("stalk", stalkMesh);
    std::vector<int> joints;
    std::vector<glm::dvec3> heads;
    for (size_t j = 0; j < kJoints.size(); ++j) {
        heads.push_back(glm::dvec3(0.0, kJoints[j], 0.0));
        const glm::dvec3 place = j == 0 ? kStalk + heads[0] : heads[j] - heads[j - 1];
        joints.push_back(glb.addJoint("joint " + std::to_string(j), j == 0 ? -1 : joints.back(), place));
    }
    glb.addSkin(stalkNode, joints, heads);

    const Shape unit = sphere(1.0, 23, 32);
    const Shape ball = ellipsoid(unit, glm::dvec3(kBallRadius)),
                swollen = ellipsoid(unit, kBallRadius * kSwollen);
    const int ballMesh = glb.addMorphMesh("ball", ball, {swollen},
                                          glb.addMaterial(paint("coral", {0.85, 0.40, 0.32}, 0.6, 0.4)));
    const int ballNode = glb.addNode("ball", ballMesh, kBall + glm::dvec3(0.0, -0.02, 0.0));

    for (const int joint : {joints[1], joints[2]})
        glb.animate({joint,
                     "rotation",
                     "LINEAR",
                     {0.0f, 1.0f, 2.0f, 3.0f, 4.0f},
                     turnsAboutZ({0.0f, kBend, 0.0f, -kBend, 0.0f}),
                     0,
                     "bend and breathe"});
    // In and out, at rest at both ends.
    glb.animate({ballNode,
                 "weights",
                 "CUBICSPLINE",
                 {0.0f, 2.0f, 4.0f},
                 {0, 0, 0, 0, 1, 0, 0, 0, 0},
                 0,
                 "bend and breathe"});
    glb.animate({joints[1],
                 "rotation",
                 "LINEAR",
                 {0.0f, 0.5f, 1.0f, 1.5f, 2.0f},
                 {0,           0, 0, 1, 0, 0.70710678f, 0, 0.70710678f, 0, 0, 0, 1, 0, -0.70710678f, 0,
                  0.70710678f, 0, 0, 0, 1},
                 1,
                 "twist"});
    return {"breathing.glb", glb.finish()};
}

} // namespace touchstone::assets

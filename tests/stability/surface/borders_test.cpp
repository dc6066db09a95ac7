// Borders between materials: the force changes there by their difference and not by more, and stands still
// with a hand on the very border.

#include "tests/stability/surface/touched_plane.h"

#include <glm/gtc/matrix_transform.hpp>

#include <string_view>

namespace touchstone::test::borders_test {
namespace {

TEST(TextureStability, ABorderBetweenMaterialsChangesTheForceByTheirDifference) {
    const double scale = 0.02, slope = scale / kSide;
    for (const TextureMode mode : kConfigurations) {
        Scene scene = reliefPlane(slopeImage(256), scale);
        scene.materials[0].haptic.height.value->texture.wrapS =
            Wrap::ClampToEdge; // else the map has a cliff there
        scene.materials.emplace_back();
        place(scene, quadMesh(0.5 * kSide, 4), 1, glm::translate(glm::dmat4(1.0), glm::dvec3(kSide, 0, 0)));
        TouchBench bench(scene, felt(mode));
        const double speed = 0.05, s = speed * bench.dt, depth = 1e-3;
        bench.step({0.03, 0.003, 0.01});
        bench.moveTo({0.03, 0.003, -depth}, 0.05);
        Watch watch(bench);
        watch.take(bench.output, 1.0);
        // m - n is no longer than the slope; Minsky's is the slope.
        const double border = kStiffness * (s + (depth + 1e-6) * slope);
        double lean = 0.0;
        bench.moveTo({0.07, 0.003, -depth}, speed, [&](const HapticOutput& out) {
            watch.take(out, border);
            if (out.proxy.x < 0.5 * kSide - 1e-3) {
                lean = std::max(lean, -out.force.x);
            } else if (out.proxy.x > 0.5 * kSide + 1e-3) {
                EXPECT_NEAR(out.force.x, 0.0, 1e-9) << "nothing of the other material is left";
            }
        });
        EXPECT_GT(lean, 0.9 * kStiffness * depth * slope);
        bench.moveTo({0.5 * kSide, 0.003, -depth}, speed); // held on the very border
        EXPECT_EQ(held(bench), 0.0);
    }
}

/// Two planes side by side that differ in one thing, the second beyond x = kSide / 2.
struct Border {
    const char* name;
    void (*differ)(Material& first, Material& second);
    bool shadedNormals = false; ///< vertex normals that lean: what shading makes of them is felt
    double maxStiffness = kStiffness;
};

HapticMaterial::Field<float> stated(double value) {
    return {static_cast<float>(value), HapticSource::Touchstone};
}

constexpr Border kBorders[] = {
    {"stiffness",
     [](Material& a, Material& b) {
         a.haptic.stiffness = stated(300.0);
         b.haptic.stiffness = stated(900.0);
     }},
    {"damping", [](Material&, Material& b) { b.haptic.damping = stated(3.0); }},
    {"friction",
     [](Material& a, Material& b) {
         a.haptic.staticFriction = a.haptic.dynamicFriction = stated(0.1);
         b.haptic.staticFriction = b.haptic.dynamicFriction = stated(0.9);
     }},
    {"friction and none",
     [](Material&, Material& b) { b.haptic.staticFriction = b.haptic.dynamicFriction = stated(0.9); }},
    {"viscous friction", [](Material& a, Material&) { a.haptic.viscousFriction = stated(4.0); }},
    {"shading", [](Material& a, Material&) { a.haptic.forceShading = ShadingChoice::Off; }, true},
    {"kinds of shading",
     [](Material& a, Material& b) {
         a.haptic.forceShading = ShadingChoice::Direction;
         b.haptic.forceShading = ShadingChoice::Projected;
     },
     true},
    {"a normal map and none", [](Material& a, Material&) { a.normalTexture = texture(0); }},
};

Scene bordered(const Border& border) {
    Scene scene;
    scene.materials.resize(2);
    for (Material& m : scene.materials)
        m.haptic.stiffness = stated(border.maxStiffness);
    scene.images.push_back(image("lean", 2, 2, 3, [](double, double) {
        return glm::vec4(0.5 + 0.5 * glm::normalize(glm::dvec3(0.3, 0.1, 1.0)), 1.0);
    }));
    border.differ(scene.materials[0], scene.materials[1]);
    Mesh mesh = quadMesh(0.5 * kSide, 4);
    if (border.shadedNormals)
        for (glm::vec3& n : mesh.normals)
            n = glm::normalize(glm::vec3(0.1f, -0.2f, 1.0f));
    place(scene, mesh, 0);
    place(scene, mesh, 1, glm::translate(glm::dmat4(1.0), glm::dvec3(kSide, 0, 0)));
    return scene;
}

TEST(MaterialBorders, TheForceChangesByTheDifferenceAndNotByMore) {
    for (const Border& border : kBorders)
        for (const FrictionMode law : {FrictionMode::Ho, FrictionMode::Elastoplastic})
            for (const double radius : {0.0, 0.5e-3})
                for (const double sink : {0.0, 0.01}) { // m/s into the surface while it strokes
                    SCOPED_TRACE(std::string(border.name) + ", r " + std::to_string(radius) + ", sinking " +
                                 std::to_string(sink));
                    HapticSettings s = felt(TextureMode::Law, radius);
                    s.stiffness = 0.0;
                    s.forceShading = ShadingMode::Material;
                    s.friction = law;
                    TouchBench bench(bordered(border), s);
                    const double speed = 0.05, step = 5e-5, depth = 1e-3;
                    bench.step({0.02, 0.003, 0.01});
                    bench.moveTo({0.02, 0.003, -depth}, 0.05);
                    std::vector<HapticOutput> ticks;
                    for (int i = 0; i < 1200; ++i) { // 0.02 to 0.08: both materials slide, settled
                        const double sunk = depth + 1e-3 * sink * i;
                        ticks.push_back(bench.step({0.02 + step * i, 0.003, -sunk}));
                    }
                    const auto settled = [&](double x) { // the force a millimetre from the border
                        return ticks[static_cast<size_t>((x - 0.02) / step)].force;
                    };
                    const glm::dvec3 before = settled(0.5 * kSide - 1e-3),
                                     after = settled(0.5 * kSide + 1e-3);
                    const double sinking = 1e-3 * sink * 40.0; // between the two, m
                    for (size_t i = 400; i < 1000; ++i) {
                        const double change = glm::distance(ticks[i].force, ticks[i - 1].force);
                        EXPECT_LE(change,
                                  glm::distance(before, after) + border.maxStiffness * (step + sinking))
                            << "at x " << ticks[i].hip.x;
                    }
                    if (sink > 0.0 || std::string_view(border.name) != "damping") {
                        EXPECT_GT(glm::distance(before, after), 0.02) << "nothing differs";
                    }
                    bench.moveTo({0.5 * kSide, 0.003, -depth}, speed); // held on the very border
                    EXPECT_LT(held(bench), 1e-12); // the filtered speed is never quite nothing
                    bench.moveTo({0.5 * kSide - 1e-3, 0.003, -depth}, speed); // and across it again
                    bench.moveTo({0.5 * kSide + 1e-3, 0.013, -depth}, speed);
                    EXPECT_LT(held(bench), 1e-12); // the filtered speed is never quite nothing
                }
}

} // namespace
} // namespace touchstone::test::borders_test

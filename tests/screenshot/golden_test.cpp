// Pictures of our own scenes on lavapipe against golden ones, and for each what must be noticed.

#include "tests/screenshot/golden.h"
#include "tests/screenshot/renderer_fixture.h"

namespace touchstone::test::golden_test {
namespace {

class Golden : public RendererFixture {
  protected:
    static View frontViewOf(const Scene& scene) {
        constexpr double kAspect = static_cast<double>(kWidth) / kHeight;
        return viewOf(frontCamera(scene, kAspect), {}, kAspect);
    }
};

TEST_F(Golden, TorusWithOverlay) {
    const auto scene = torusScene();
    const View view = viewFor(*scene);
    expectMatchesGolden("torus", draw(scene, view, touchOverlay()));

    expectMutationIsSeen("torus", "overlay off", draw(scene, view));
    const auto swapped = torusScene();
    swapped->materials[0].normalTexture.image = 0;
    expectMutationIsSeen("torus", "normal map swapped", draw(swapped, view, touchOverlay()));
    const auto plain = torusScene();
    plain->materials[0].baseColorTexture.image = 1;
    expectMutationIsSeen("torus", "base colour map swapped", draw(plain, view, touchOverlay()));
    View dark = view;
    dark.lights[0].irradiance = glm::vec3(0.0f);
    expectMutationIsSeen("torus", "key light off", draw(scene, dark, touchOverlay()));
    View flat = view;
    flat.surroundings = Surroundings::dark();
    expectMutationIsSeen("torus", "surroundings off", draw(scene, flat, touchOverlay()));
}

TEST_F(Golden, HiddenOverlayShinesThrough) {
    const auto scene = torusScene();
    const View view = viewFor(*scene);
    Overlay overlay = touchOverlay();
    overlay.spheres[0].radius = 0.010;
    overlay.discs.clear();
    overlay.spheres.pop_back();
    expectMatchesGolden("hidden_overlay", draw(scene, view, overlay));
    overlay.hiddenAlpha = 0.0f;
    expectMutationIsSeen("hidden_overlay", "see-through pass off", draw(scene, view, overlay));
}

TEST_F(Golden, FeatureBoard) {
    const auto scene = featureBoard();
    const View view = frontViewOf(*scene);
    expectMatchesGolden("features", draw(scene, view));
    for (int tile = 0; tile < 12; ++tile)
        expectMutationIsSeen("features", "tile " + std::to_string(tile), draw(featureBoard(tile), view));
}

TEST_F(Golden, GlassBoard) {
    const auto scene = glassBoard();
    const View view = frontViewOf(*scene);
    expectMatchesGolden("glass", draw(scene, view));
    for (int wrong = 0; wrong < 5; ++wrong)
        expectMutationIsSeen("glass", "mistake " + std::to_string(wrong), draw(glassBoard(wrong), view));
}

TEST_F(Golden, FalseColorHeight) {
    const auto scene = torusScene();
    View view = viewFor(*scene);
    view.mode = ViewMode::Height;
    expectMatchesGolden("height", draw(scene, view));
    const auto swapped = torusScene();
    swapped->materials[0].haptic.height.value->texture.image = 1;
    expectMutationIsSeen("height", "map swapped", draw(swapped, view));
}

TEST_F(Golden, FalseColorFactors) {
    const auto scene = hapticBoard();
    View view = frontViewOf(*scene);
    for (const ViewMode mode : {ViewMode::Friction, ViewMode::Stiffness, ViewMode::Damping}) {
        view.mode = mode;
        const std::string name(viewModeName(mode));
        expectMatchesGolden(name, draw(scene, view));
        expectMutationIsSeen(name, "maps and vertex values swapped", draw(hapticBoard(true), view));
    }
}

TEST_F(Golden, NormalsAndUv) {
    const auto scene = torusScene();
    View view = viewFor(*scene);
    view.mode = ViewMode::Normals;
    expectMatchesGolden("normals", draw(scene, view));
    const auto smooth = torusScene();
    smooth->materials[0].normalScale = 0.0f;
    expectMutationIsSeen("normals", "normal map off", draw(smooth, view));

    view.mode = ViewMode::Uv;
    expectMatchesGolden("uv", draw(scene, view));
    const auto turned = torusScene();
    for (glm::vec2& uv : turned->meshes[0].uv0)
        std::swap(uv.x, uv.y);
    expectMutationIsSeen("uv", "U and V swapped", draw(turned, view));
}

TEST_F(Golden, TiltDihedralAndEffects) {
    View view = viewFor(*torusScene());
    view.mode = ViewMode::Tilt;
    expectMatchesGolden("tilt", draw(torusScene(), view));
    const auto smooth = torusScene();
    smooth->materials[0].normalScale = 0.0f;
    expectMutationIsSeen("tilt", "normal map off", draw(smooth, view));
    const auto raised = torusScene();
    raised->materials[0].normalTexture = {};
    expectMatchesGolden("tilt_of_height", draw(raised, view));
    expectMutationIsSeen("tilt_of_height", "normal map instead", draw(torusScene(), view));

    view.mode = ViewMode::Dihedral;
    expectMatchesGolden("dihedral", draw(torusScene(24, 12), view));
    expectMutationIsSeen("dihedral", "finer triangles", draw(torusScene(96, 12), view));

    const auto board = hapticBoard();
    View front = frontViewOf(*board);
    front.mode = ViewMode::Effects;
    renderer_->setMaterialColors({{0.9f, 0.6f, 0.0f}, {0.3f, 0.7f, 0.9f}, {0.0f, 0.6f, 0.4f}});
    expectMatchesGolden("effects", draw(board, front));
    renderer_->setMaterialColors({{0.9f, 0.6f, 0.0f}, {0.3f, 0.7f, 0.9f}});
    expectMutationIsSeen("effects", "a colour missing", draw(board, front));
    renderer_->setMaterialColors({});
}

} // namespace
} // namespace touchstone::test::golden_test

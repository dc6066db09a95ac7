// Parts of a scene and what is drawn over all of it: clipping plane, hidden objects, wireframe, grid,
// orthographic views.

#include "tests/screenshot/golden.h"
#include "tests/screenshot/renderer_fixture.h"

namespace touchstone::test::part_test {
namespace {

class Parts : public RendererFixture {
  protected:
    /// A torus and a sphere in its hole.
    static std::shared_ptr<Scene> ringAndBall() {
        auto scene = torusScene(96, 40);
        Material blue;
        blue.baseColor = {0.1f, 0.25f, 0.7f, 1.0f};
        blue.metallic = 0.0f;
        scene->materials.push_back(blue);
        place(*scene, sphereMesh(0.03, 48, 24), 1);
        return scene;
    }
};

TEST_F(Parts, AClippingPlaneShowsTheInside) {
    const auto scene = ringAndBall();
    View view = viewFor(*scene);
    view.part.clip = clipPlane({0.2, 0.1, 1.0}, 0.0);
    expectMatchesGolden("clipped", draw(scene, view));
    View whole = view;
    whole.part = {};
    expectMutationIsSeen("clipped", "no plane", draw(scene, whole));
    View moved = view;
    moved.part.clip->offset = 0.003;
    expectMutationIsSeen("clipped", "a plane 3 mm farther", draw(scene, moved));
    const auto fronts = ringAndBall();
    fronts->materials[0].haptic.sides = SideChoice::Front;
    expectMutationIsSeen("clipped", "insides that are not felt", draw(fronts, view));
    view.mode = ViewMode::Stiffness;
    const PixelData map = draw(scene, view);
    view.part = {};
    EXPECT_GT(failingShare(map, draw(scene, view)), 0.05) << "maps are cut, too";
}

/// Failed: a cut glass of one side lacked its inner walls.
TEST_F(Parts, ACutGlassShowsItsInside) {
    const auto glass = [](bool doubleSided, SideChoice felt) {
        auto scene = ringAndBall();
        scene->materials[1].alphaMode = AlphaMode::Blend;
        scene->materials[1].baseColor.w = 0.4f;
        scene->materials[1].doubleSided = doubleSided;
        scene->materials[1].haptic.sides = felt;
        return scene;
    };
    View view = viewFor(*glass(false, SideChoice::Both));
    view.part.clip = clipPlane({0.2, 0.1, 1.0}, 0.0);
    const PixelData cut = draw(glass(false, SideChoice::Both), view);
    EXPECT_LT(failingShare(cut, draw(glass(true, SideChoice::Both), view)), 1e-9);
    EXPECT_GT(failingShare(cut, draw(glass(false, SideChoice::Front), view)), 0.01)
        << "what is felt from outside only";
}

/// A field of a closed mesh is filled, and the plane leaves a face on it; that of an open one is a shell for
/// the hand, and the eye looks into it. Failed: it was drawn filled.
TEST_F(Parts, TheShellOfAnOpenMeshIsHollowWhereItIsCut) {
    const auto made = [](bool field) {
        auto scene = ringAndBall();
        Mesh& ball = scene->meshes[1];
        ball.indices.resize(ball.indices.size() - 3 * 48); // without a part of its triangles: open
        scene->materials[1].haptic.implicit = field;
        return scene;
    };
    View view = viewFor(*made(false));
    view.part.clip = clipPlane({0.2, 0.1, 1.0}, 0.0);
    const PixelData open = draw(made(false), view), filled = draw(made(true), view);
    EXPECT_GT(failingShare(filled, open), 0.01) << "a face covers its inside";
    view.shells = {1};
    EXPECT_LT(failingShare(draw(made(true), view), open), 1e-9);
    const auto fronts = made(true);
    fronts->materials[1].haptic.sides = SideChoice::Front;
    EXPECT_LT(failingShare(draw(fronts, view), open), 1e-9) << "a field has both sides";
}

/// The plane cuts the model as it rests, and what moves takes its cut along.
TEST_F(Parts, TheCutMovesWithItsObject) {
    const auto scene = ringAndBall();
    View view = viewFor(*scene);
    view.part.clip = clipPlane({1, 0, 0}, 0.0);
    renderer_->setScene(scene);
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), glm::pi<double>(), glm::dvec3(0, 1, 0));
    renderer_->setInstancePoses(std::array{turned, turned});
    renderer_->render(view, {}, kWidth, kHeight);
    const PixelData carried = renderer_->readPixels();
    auto posed = ringAndBall();
    for (Instance& instance : posed->instances)
        instance.sceneFromMesh = turned;
    view.part.clip = clipPlane({-1, 0, 0}, 0.0);
    EXPECT_LT(failingShare(carried, draw(posed, view)), 1e-3);
}

TEST_F(Parts, HiddenObjectsAreNotDrawn) {
    const auto scene = ringAndBall();
    View view = viewFor(*scene);
    view.part.hidden = {0};
    expectMatchesGolden("hidden", draw(scene, view));
    auto alone = ringAndBall();
    alone->instances.erase(alone->instances.begin());
    View all = view;
    all.part = {};
    EXPECT_LT(failingShare(draw(scene, view), draw(alone, all)), 1e-9);
    expectMutationIsSeen("hidden", "nothing hidden", draw(scene, all));
    view.part.hidden = {0, 1};
    (void)draw(scene, view);
    EXPECT_EQ(renderer_->statistics().drawCalls, 0u);
}

TEST_F(Parts, WireframeShowsTheTrianglesOfWhatIsSeen) {
    const auto scene = ringAndBall();
    View view = viewFor(*scene);
    view.wireframe = true;
    view.part.clip = clipPlane({0.2, 0.1, 1.0}, 0.0);
    expectMatchesGolden("wireframe", draw(scene, view));
    View plain = view;
    plain.wireframe = false;
    expectMutationIsSeen("wireframe", "no edges", draw(scene, plain));
    View whole = view;
    whole.part = {};
    expectMutationIsSeen("wireframe", "edges of what is cut away", draw(scene, whole));
    view.mode = ViewMode::Normals;
    plain.mode = ViewMode::Normals;
    EXPECT_GT(failingShare(draw(scene, view), draw(scene, plain)), 0.02);
}

/// Failed: edges of a fixed opacity painted 64,800 triangles nearly black.
TEST_F(Parts, WireframeOfSmallTrianglesLeavesTheSurfaceVisible) {
    const auto scene = torusScene(360, 90);
    View view = viewFor(*scene);
    const PixelData plain = draw(scene, view);
    view.wireframe = true;
    const PixelData edges = draw(scene, view);
    double before = 0.0, after = 0.0; // of the pixels that the edges change
    for (size_t i = 0; i < plain.bytes.size(); i += 4)
        for (size_t channel = i; channel < i + 3 && plain.bytes[i] != edges.bytes[i]; ++channel) {
            before += std::to_integer<int>(plain.bytes[channel]);
            after += std::to_integer<int>(edges.bytes[channel]);
        }
    EXPECT_GT(before, 1e6) << "they are seen";
    EXPECT_GT(after, 0.6 * before) << "and not alone";
    EXPECT_LT(after, 0.95 * before);
}

TEST_F(Parts, GridLinesAreHiddenByTheModel) {
    const auto scene = ringAndBall();
    const View view = viewFor(*scene);
    Overlay overlay;
    for (int i = -10; i <= 10; ++i)
        overlay.grid.push_back({.from = {0.01 * i, 0.0, -0.1}, .to = {0.01 * i, 0.0, 0.1}});
    expectMatchesGolden("grid", draw(scene, view, overlay));
    std::swap(overlay.grid, overlay.lines);
    expectMutationIsSeen("grid", "lines that shine through", draw(scene, view, overlay));
}

/// Vertices' heights as colours; a mesh that has none is grey, also where its lowest neighbour is negative.
TEST_F(Parts, TheHeightsOfVerticesAreColours) {
    const auto board = [](float sign) {
        auto scene = std::make_shared<Scene>();
        scene->materials.resize(1);
        for (int plate = 0; plate < 2; ++plate) {
            Mesh mesh = quadMesh(0.02, 16);
            if (plate == 0)
                for (const glm::vec3& p : mesh.positions)
                    mesh.heights.push_back(sign * 0.1f * p.x * (p.y > 0.0f ? 1.0f : 0.5f));
            place(*scene, std::move(mesh), 0,
                  glm::translate(glm::dmat4(1.0), glm::dvec3(0.045 * (plate - 0.5), 0.0, 0.0)));
        }
        return scene;
    };
    constexpr double kAspect = static_cast<double>(kWidth) / kHeight;
    const auto scene = board(1.0f);
    View view = viewOf(frontCamera(*scene, kAspect), {}, kAspect);
    view.mode = ViewMode::Height;
    expectMatchesGolden("vertex_heights", draw(scene, view));
    expectMutationIsSeen("vertex_heights", "heights the other way", draw(board(-1.0f), view));
}

/// Of equal spheres the nearer is the larger in a perspective alone.
TEST_F(Parts, OrthographicViewsShowEqualsEqual) {
    auto scene = std::make_shared<Scene>();
    Material grey;
    scene->materials.push_back(grey);
    for (const double z : {0.08, -0.08})
        place(*scene, sphereMesh(0.02, 48, 24), 0,
              glm::translate(glm::dmat4(1.0), glm::dvec3(z > 0 ? -0.04 : 0.04, 0.0, z)));
    constexpr double kAspect = static_cast<double>(kWidth) / kHeight;
    OrbitCamera camera = frontCamera(*scene, kAspect);
    const auto widths = [&] {
        const View view = viewOf(camera, {}, kAspect);
        const PixelData pixels = draw(scene, view);
        View none = view;
        none.part.hidden = {0, 1};
        const PixelData empty = draw(scene, none);
        int left = 0, right = 0;
        for (int x = 0; x < kWidth; ++x)
            for (int y = 0; y < kHeight; ++y)
                (x < kWidth / 2 ? left : right) += at(pixels, x, y) != at(empty, x, y);
        return static_cast<double>(left) / right;
    };
    EXPECT_GT(widths(), 1.2);
    camera.orthographic = true;
    camera.frame(scene->bounds, kAspect);
    EXPECT_NEAR(widths(), 1.0, 0.02);
    const View view = viewOf(camera, {}, kAspect);
    EXPECT_TRUE(view.orthographic());
    expectMatchesGolden("orthographic", draw(scene, view));
    camera.zoom(0.05); // the near plane stays before the model
    EXPECT_LT(camera.nearPlane(), -0.1);
}

} // namespace
} // namespace touchstone::test::part_test

// Frames over a kept picture against whole drawings of the same, and what makes them begin again.

#include "engine/core/error.h"
#include "tests/screenshot/renderer_fixture.h"

#include <algorithm>
#include <functional>
#include <string>

namespace touchstone::test::kept_picture_test {
namespace {

constexpr glm::ivec2 kCoarse{160, 90};

/// Beside what the feature board has: layers and unlit colours; and, where wanted, points and lines.
std::shared_ptr<Scene> layerBoard(bool strokes = false) {
    auto scene = std::make_shared<Scene>();
    for (int tile = 0; tile < (strokes ? 8 : 6); ++tile) {
        Material material;
        material.baseColor = {0.6f, 0.3f, 0.2f, 1.0f};
        material.metallic = tile == 3 ? 1.0f : 0.0f;
        material.roughness = 0.5f;
        Mesh mesh = sphereMesh(0.024, 40, 24, glm::vec2(2.0f, 1.0f));
        if (tile == 0 || tile == 2)
            material.sheen.color = {0.8f, 0.6f, 0.5f};
        if (tile == 1 || tile == 2)
            material.clearcoat.factor = 0.9f;
        material.unlit = tile == 4;
        if (tile == 5)
            material.emissive = {0.1f, 0.4f, 0.2f};
        if (tile >= 6) {
            mesh.indices.clear();
            for (uint32_t i = 0; i < mesh.positions.size(); ++i)
                (tile == 6 ? mesh.pointIndices : mesh.lineIndices).push_back(i);
            mesh.lineIndices.resize(mesh.lineIndices.size() / 2 * 2);
        }
        scene->materials.push_back(material);
        place(*scene, std::move(mesh), tile,
              glm::translate(glm::dmat4(1.0),
                             glm::dvec3(0.055 * (tile % 4 - 1.5), 0.055 * (1 - tile / 4), 0.0)));
    }
    return scene;
}

class KeptPictureTest : public RendererFixture {
  protected:
    /// Frames until one is drawn over the kept picture; how many.
    static int finish(const View& view, const Overlay& overlay, const glm::ivec2& size) {
        for (int frame = 1; frame < 1000; ++frame) {
            if (renderer_->renderKept(view, overlay, kCoarse, size) == PictureState::Kept)
                return frame;
            gpu_->waitIdle();
        }
        ADD_FAILURE() << "the picture is never complete";
        return 0;
    }

    /// Largest difference of a byte between the last frame and a whole drawing in its size.
    static int differenceFromWhole(View view, const Overlay& overlay) {
        const PixelData kept = renderer_->readPixels();
        view.allowedError = 0.0;
        renderer_->render(view, overlay, kept.width, kept.height);
        const PixelData whole = renderer_->readPixels();
        EXPECT_EQ(kept.bytes.size(), whole.bytes.size());
        int largest = 0;
        for (size_t i = 0; i < std::min(kept.bytes.size(), whole.bytes.size()); ++i)
            largest = std::max(largest, std::abs(std::to_integer<int>(kept.bytes[i]) -
                                                 std::to_integer<int>(whole.bytes[i])));
        return largest;
    }

    /// With the probe near the surface, so that its shadow is seen.
    static View shadowed(View view, const glm::dvec3& probe, double radius = 0.003) {
        view.probe = {probe, radius};
        return view;
    }
    static View frontOf(const Scene& scene) {
        constexpr double kAspect = static_cast<double>(kWidth) / kHeight;
        return viewOf(frontCamera(scene, kAspect), {}, kAspect);
    }
    static constexpr glm::ivec2 kSize{kWidth, kHeight};
};

TEST_F(KeptPictureTest, IsTheWholeDrawingWhereverTheProbeCastsItsShadow) {
    const auto scene = torusScene();
    renderer_->setScene(scene);
    const View view = viewFor(*scene);
    finish(view, {}, kSize);
    EXPECT_EQ(differenceFromWhole(view, {}), 0) << "without a shadow the bytes are the same";
    const Overlay overlay = touchOverlay();
    // Over the surface, inside of it, beside the model, behind the eye.
    for (const glm::dvec3& probe :
         {glm::dvec3(0.06, 0.03, 0.0), glm::dvec3(0.0, 0.026, 0.06), glm::dvec3(-0.06, 0.0, 0.0),
          glm::dvec3(0.2, 0.1, 0.0), glm::dvec3(0.3, 0.6, 0.9)}) {
        const View with = shadowed(view, probe);
        ASSERT_EQ(renderer_->renderKept(with, overlay, kCoarse, kSize), PictureState::Kept)
            << "the probe moves without a new picture";
        EXPECT_LE(differenceFromWhole(with, overlay), 1) << probe.x << ' ' << probe.y << ' ' << probe.z;
    }
    // The comparison sees a shadow that is missing.
    ASSERT_EQ(renderer_->renderKept(view, {}, kCoarse, kSize), PictureState::Kept);
    EXPECT_GT(differenceFromWhole(shadowed(view, {0.06, 0.03, 0.0}), {}), 20);
}

TEST_F(KeptPictureTest, IsTheWholeDrawingWithEveryKindOfMaterial) {
    for (const auto& scene : {layerBoard(), featureBoard(), glassBoard(), hapticBoard()}) {
        renderer_->setScene(scene);
        View view = shadowed(frontOf(*scene), {0.01, 0.02, 0.03}, 0.004);
        view.lights[1] = {{1.0, 0.3, 0.5}, glm::vec3(0.4f, 0.3f, 0.2f)};
        finish(view, touchOverlay(), kSize);
        EXPECT_LE(differenceFromWhole(view, touchOverlay()), 1);
    }
    const auto board = hapticBoard();
    renderer_->setScene(board);
    for (size_t mode = 1; mode < kViewModeNames.size(); ++mode) {
        View view = shadowed(frontOf(*board), {0.01, 0.02, 0.03});
        view.mode = static_cast<ViewMode>(mode);
        finish(view, touchOverlay(), kSize);
        EXPECT_EQ(differenceFromWhole(view, touchOverlay()), 0) << kViewModeNames[mode];
    }
}

TEST_F(KeptPictureTest, IsTheWholeDrawingOfWhatIsCut) {
    const auto scene = torusScene();
    renderer_->setScene(scene);
    for (const ViewMode mode : {ViewMode::Shaded, ViewMode::Height}) {
        View view = shadowed(viewFor(*scene), {0.0, 0.0, 0.05}, 0.006);
        view.mode = mode;
        view.part.clip = clipPlane({0.2, 0.1, 1.0}, 0.0);
        finish(view, touchOverlay(), kSize);
        EXPECT_LE(differenceFromWhole(view, touchOverlay()), 1) << viewModeName(mode);
    }
}

/// Half floats end at 65,504.
TEST_F(KeptPictureTest, LightBeyondHalfFloatsStaysWhiteInTheShadow) {
    const auto scene = torusScene();
    scene->materials[0].emissive = glm::vec3(1e9f);
    renderer_->setScene(scene);
    const View view = shadowed(viewFor(*scene), {0.06, 0.03, 0.0});
    finish(view, {}, kSize);
    EXPECT_LE(differenceFromWhole(view, {}), 1);
}

/// The poses of the scene before say nothing about this one.
TEST_F(KeptPictureTest, AnotherSceneOfAsManyObjectsIsKeptWhole) {
    const auto scene = torusScene(), elsewhere = torusScene();
    elsewhere->instances[0].sceneFromMesh = glm::translate(glm::dmat4(1.0), {0.0, 0.01, 0.0});
    renderer_->setScene(scene);
    const View view = viewFor(*scene);
    finish(view, {}, kSize);
    renderer_->setScene(elsewhere);
    finish(view, {}, kSize);
    const uint64_t before = renderer_->statistics().drawnTriangles;
    ASSERT_EQ(renderer_->renderKept(view, {}, kCoarse, kSize), PictureState::Kept);
    EXPECT_EQ(renderer_->statistics().drawnTriangles, before) << "nothing is drawn over it";
    EXPECT_EQ(differenceFromWhole(view, {}), 0);
}

TEST_F(KeptPictureTest, TheEdgesOfTrianglesAreInEveryFrame) {
    const auto scene = torusScene(48, 24);
    renderer_->setScene(scene);
    View view = viewFor(*scene);
    view.wireframe = true;
    for (int frame = 0; frame < 20; ++frame) {
        EXPECT_EQ(renderer_->renderKept(view, {}, kCoarse, kSize), PictureState::Coarse);
        gpu_->waitIdle();
    }
    EXPECT_EQ(differenceFromWhole(view, {}), 0);
}

TEST_F(KeptPictureTest, PointsAndLinesAreKeptButForTheirShadow) {
    const auto board = layerBoard(true);
    renderer_->setScene(board);
    View view = frontOf(*board);
    finish(view, touchOverlay(), kSize);
    EXPECT_EQ(differenceFromWhole(view, touchOverlay()), 0);
    view = shadowed(view, {0.01, 0.02, 0.03}, 0.004);
    ASSERT_EQ(renderer_->renderKept(view, touchOverlay(), kCoarse, kSize), PictureState::Kept);
    EXPECT_LE(differenceFromWhole(view, touchOverlay()), 20) << "the shadow of a pixel, not of its point";
}

TEST_F(KeptPictureTest, LargePicturesAreDrawnInBands) {
    const auto scene = featureBoard();
    renderer_->setScene(scene);
    constexpr glm::ivec2 kLarge{1400, 900}; // 1.26 million pixels, four bands of other heights
    constexpr double kAspect = static_cast<double>(kLarge.x) / kLarge.y;
    const View view = viewOf(frontCamera(*scene, kAspect), {}, kAspect);
    EXPECT_GT(finish(view, {}, kLarge), 3) << "not in one step";
    EXPECT_EQ(differenceFromWhole(view, {}), 0);
}

TEST_F(KeptPictureTest, ManyTrianglesAreDrawnInSteps) {
    const auto scene = torusScene(800, 250); // 400,000 triangles
    renderer_->setScene(scene);
    EXPECT_GT(finish(viewFor(*scene), {}, kSize), 4);
    EXPECT_EQ(differenceFromWhole(viewFor(*scene), {}), 0);
}

TEST_F(KeptPictureTest, WhatMovesIsDrawnOverIt) {
    const auto scene = featureBoard();
    renderer_->setScene(scene);
    const View view = shadowed(frontOf(*scene), {0.01, 0.02, 0.03}, 0.004);
    finish(view, {}, kSize);
    std::vector<glm::dmat4> poses;
    for (const Instance& instance : scene->instances)
        poses.push_back(instance.sceneFromMesh);
    const auto move = [&] {
        poses[5][3].x += 0.003; // opaque
        poses[7][3].y += 0.002; // blended
        renderer_->setInstancePoses(poses);
        return renderer_->renderKept(view, touchOverlay(), kCoarse, kSize);
    };
    EXPECT_EQ(move(), PictureState::Coarse) << "the kept picture shows it in its old place";
    PictureState state = PictureState::Coarse;
    for (int frame = 0; frame < 100 && state != PictureState::Kept; ++frame) {
        gpu_->waitIdle();
        state = move();
    }
    ASSERT_EQ(state, PictureState::Kept) << "it is completed while the object moves";
    for (int frame = 0; frame < 5; ++frame) {
        ASSERT_EQ(move(), PictureState::Kept);
        EXPECT_LE(differenceFromWhole(view, touchOverlay()), 1);
    }
    // It stops, and goes on: no reason to begin again.
    ASSERT_EQ(renderer_->renderKept(view, touchOverlay(), kCoarse, kSize), PictureState::Kept);
    EXPECT_EQ(move(), PictureState::Kept);
    poses[0][3].x += 0.001;
    EXPECT_EQ(move(), PictureState::Coarse) << "another one rested until now";
}

TEST_F(KeptPictureTest, BeginsAgainWithEverythingThatItShows) {
    const auto scene = torusScene(48, 24), other = torusScene(40, 20);
    renderer_->setScene(scene);
    View view = shadowed(viewFor(*scene), {0.06, 0.03, 0.0});
    glm::ivec2 size = kSize, coarse = kCoarse;
    Overlay overlay;
    const auto environment = prefilter({.width = 8, .height = 4, .texels = std::vector(32, glm::vec3(0.7f))});
    const struct {
        const char* name;
        bool begins;
        std::function<void()> change;
    } kCases[] = {
        {"nothing", false, [] {}},
        {"probe", false, [&] { view.probe.centre.x += 0.01; }},
        {"no probe", false, [&] { view.probe.radius = 0.0; }},
        {"overlay", false, [&] { overlay = touchOverlay(); }},
        {"error of simplified meshes", false, [&] { view.allowedError = 1.0; }},
        {"coarse size", false,
         [&] {
             coarse = {200, 120};
         }},
        {"camera", true, [&] { view.viewFromWorkspace[3].x += 0.001; }},
        {"projection", true, [&] { view.clipFromView[0][0] *= 1.01; }},
        {"placing of the scene", true, [&] { view.workspaceFromScene.scale *= 1.01; }},
        {"view mode", true, [&] { view.mode = ViewMode::Height; }},
        {"view mode back", true, [&] { view.mode = ViewMode::Shaded; }},
        {"light", true, [&] { view.lights[0].irradiance *= 0.5f; }},
        {"second light", true,
         [&] {
             view.lights[1] = {{0.0, 1.0, 0.0}, glm::vec3(0.2f)};
         }},
        {"surroundings", true, [&] { view.surroundings.horizon *= 0.5f; }},
        {"lamp", true, [&] { view.surroundings.lamps[0].sharpness *= 2.0; }},
        {"background", true, [&] { view.background.top.x = 0.5f; }},
        {"exposure", true, [&] { view.exposure = 0.7f; }},
        {"width of lines and points", true, [&] { view.pixelScale = 2.0f; }},
        {"size", true,
         [&] {
             size = {333, 111};
         }},
        {"environment", true, [&] { renderer_->setEnvironment(environment); }},
        {"environment back", true, [&] { renderer_->setEnvironment(nullptr); }},
        {"colours of materials", true,
         [&] {
             renderer_->setMaterialColors({{0.9f, 0.1f, 0.1f}});
         }},
        {"clipping plane", true,
         [&] {
             view.part.clip = clipPlane({0.3, 0.2, 1.0}, 0.0);
         }},
        {"a plane elsewhere", true, [&] { view.part.clip->offset = 0.002; }},
        {"no plane", true, [&] { view.part.clip.reset(); }},
        {"hidden", true, [&] { view.part.hidden = {0}; }},
        {"seen again", true, [&] { view.part.hidden.clear(); }},
        {"orthographic", true,
         [&] { view.clipFromView = glm::orthoRH_ZO(-0.16, 0.16, -0.09, 0.09, -1.0, 1.0); }},
        {"another scene", true, [&] { renderer_->setScene(other); }},
        {"no scene", true, [&] { renderer_->setScene(nullptr); }},
        {"a scene again", true, [&] { renderer_->setScene(scene); }},
        {"pose", true,
         [&] {
             std::vector<glm::dmat4> poses(1, glm::translate(glm::dmat4(1.0), {0.0, 0.01, 0.0}));
             renderer_->setInstancePoses(poses);
         }},
    };
    finish(view, overlay, size);
    for (const auto& test : kCases) {
        test.change();
        const PictureState next = renderer_->renderKept(view, overlay, coarse, size);
        EXPECT_EQ(next, test.begins ? PictureState::Coarse : PictureState::Kept) << test.name;
        finish(view, overlay, size);
        EXPECT_LE(differenceFromWhole(view, overlay), 1) << test.name;
    }
    renderer_->setMaterialColors({});
}

TEST_F(KeptPictureTest, AnotherSizeWhileItIsRefined) {
    const auto scene = torusScene(800, 250);
    renderer_->setScene(scene);
    const View view = viewFor(*scene);
    for (int i = 0; i < 12; ++i) {
        const glm::ivec2 size(200 + 37 * i, 300 - 17 * i);
        EXPECT_EQ(renderer_->renderKept(view, {}, kCoarse, size), PictureState::Coarse);
        for (int step = 0; step < i % 4; ++step)
            EXPECT_NE(renderer_->renderKept(view, {}, kCoarse, size), PictureState::Coarse);
    }
    finish(view, {}, kSize);
    EXPECT_EQ(differenceFromWhole(view, {}), 0);
}

TEST_F(KeptPictureTest, NothingIsCompiledWhenItIsFirstDrawn) {
    const auto prepared = prepareScene(torusScene(24, 12));
    compileAhead(gpu_->name(), prepared);
    compileAhead("no device of this name", prepared); // is no failure
    SceneRenderer fresh(*gpu_);
    fresh.warmUp();
    fresh.beginScene(prepared);
    while (!fresh.continueScene(0.0)) {
    }
    const uint64_t compiled = fresh.statistics().pipelines;
    EXPECT_GT(compiled, 0u);
    const View view = shadowed(viewFor(*prepared->scene), {0.06, 0.03, 0.0});
    for (int frame = 0; frame < 100; ++frame) {
        if (fresh.renderKept(view, touchOverlay(), kCoarse, kSize) == PictureState::Kept)
            break;
        gpu_->waitIdle();
    }
    EXPECT_EQ(fresh.renderKept(view, touchOverlay(), kCoarse, kSize), PictureState::Kept);
    EXPECT_EQ(fresh.statistics().pipelines, compiled);
}

TEST_F(KeptPictureTest, SmallestAndImpossibleSizes) {
    const auto scene = torusScene(24, 12);
    renderer_->setScene(scene);
    const View view = shadowed(viewFor(*scene), {0.06, 0.03, 0.0});
    for (const glm::ivec2& size :
         {glm::ivec2(1, 1), glm::ivec2(0, 0), glm::ivec2(-7, 3), glm::ivec2(1, 2000), glm::ivec2(16384, 1)}) {
        finish(view, touchOverlay(), size);
        EXPECT_LE(differenceFromWhole(view, touchOverlay()), 1) << size.x << 'x' << size.y;
    }
}

} // namespace
} // namespace touchstone::test::kept_picture_test

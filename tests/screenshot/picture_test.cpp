// What must hold for any picture: closed forms of single pixels, invariances, and the same bits every time.

#include "engine/core/error.h"
#include "tests/screenshot/golden.h"
#include "tests/screenshot/renderer_fixture.h"
#include "tests/support/kept_environment.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>

namespace touchstone::test::picture_test {
namespace {

class Picture : public RendererFixture {
  protected:
    /// Looks straight at the unit square [-1, 1]^2 of z = 0, which fills a square image; no light but
    /// emission.
    static View squareView() {
        OrbitCamera camera;
        camera.sceneRadius = 2.0;
        camera.distance = 1.0 / std::tan(0.5 * camera.fovY);
        View view = viewOf(camera, {}, 1.0);
        for (DirectionalLight& light : view.lights)
            light.irradiance = glm::vec3(0.0f);
        view.surroundings = Surroundings::dark();
        view.background = {glm::vec3(0.0f), glm::vec3(0.0f)};
        return view;
    }

    static Material emitter(const TextureRef& reference) {
        Material material;
        material.baseColor = {0.0f, 0.0f, 0.0f, 1.0f};
        material.metallic = 0.0f;
        material.emissive = glm::vec3(1.0f);
        material.emissiveTexture = reference;
        return material;
    }

    /// The byte that an emitted sRGB byte becomes: linear, tone mapped (below the knee a colour only loses
    /// the offset that the tone mapper takes from its smallest channel), and back.
    static int expectedByte(int byte) {
        const double c = byte / 255.0;
        const double linear = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
        const double mapped = linear - (linear < 0.08 ? linear - 6.25 * linear * linear : 0.04);
        const double srgb =
            mapped <= 0.0031308 ? 12.92 * mapped : 1.055 * std::pow(mapped, 1.0 / 2.4) - 0.055;
        return static_cast<int>(std::lround(255.0 * srgb));
    }
};

TEST_F(Picture, EmittedGreysComeOutAsTheClosedFormSays) {
    const View view = squareView();
    for (const int byte : {0, 20, 60, 90, 128, 180, 215}) {
        auto scene = std::make_shared<Scene>();
        scene->images.push_back(image(
            "grey", 4, 4, 3, [&](double, double) { return glm::vec4(static_cast<float>(byte) / 255.0f); }));
        scene->materials.push_back(emitter(texture(0)));
        place(*scene, quadMesh(1.0), 0);
        const PixelData pixels = draw(scene, view, {}, 32, 32);
        EXPECT_NEAR(at(pixels, 16, 16).x, expectedByte(byte), 1) << byte;
        EXPECT_EQ(at(pixels, 16, 16).x, at(pixels, 16, 16).z);
    }
}

TEST_F(Picture, WrapModesAndTransformsPutEachTexelWhereTheEngineSays) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    // 8 x 8 texels of as many greys.
    const auto grey = [](int x, int y) { return 40 + 2 * (8 * y + x); };
    const Image texels = image("texels", 8, 8, 3, [&](double u, double v) {
        return glm::vec4(static_cast<float>(grey(static_cast<int>(8 * u), static_cast<int>(8 * v))) / 255.0f);
    });
    const auto wrapped = [](float c, Wrap wrap) {
        float texel = 0.0f;
        switch (wrap) {
        case Wrap::Repeat:
            texel = c - std::floor(c);
            break;
        case Wrap::MirroredRepeat: {
            const float t = c - 2.0f * std::floor(0.5f * c);
            texel = t > 1.0f ? 2.0f - t : t;
            break;
        }
        case Wrap::ClampToEdge:
            texel = c;
            break;
        }
        return std::clamp(static_cast<int>(std::floor(8.0f * texel)), 0, 7);
    };
    const View view = squareView();
    for (int trial = 0; trial < 12; ++trial) {
        TextureRef reference = texture(0);
        reference.nearest = true;
        reference.wrapS = static_cast<Wrap>(trial % 3);
        reference.wrapT = static_cast<Wrap>((trial / 3) % 3);
        reference.rotation = 6.0f * unit(random);
        reference.scale = {0.5f + 2.0f * unit(random), 0.5f + 2.0f * unit(random)};
        reference.offset = {unit(random) - 0.5f, unit(random) - 0.5f};
        reference.texCoord = trial % 2;
        auto scene = std::make_shared<Scene>();
        scene->images.push_back(texels);
        scene->materials.push_back(emitter(reference));
        Mesh mesh = quadMesh(1.0);
        if (reference.texCoord == 1) {
            mesh.uv1 = mesh.uv0;
            for (glm::vec2& uv : mesh.uv0)
                uv = glm::vec2(0.5f);
        }
        place(*scene, std::move(mesh), 0);
        constexpr int kSize = 128;
        const PixelData pixels = draw(scene, view, {}, kSize, kSize);
        int wrong = 0;
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) {
                const glm::vec2 uv =
                    reference.transform(glm::vec2(glm::dvec2(x + 0.5, y + 0.5) / double(kSize)));
                const int expected =
                    expectedByte(grey(wrapped(uv.x, reference.wrapS), wrapped(uv.y, reference.wrapT)));
                wrong += std::abs(at(pixels, x, y).x - expected) > 1;
            }
        // Only pixels on the border between two texels may round to the other side.
        EXPECT_LT(wrong, kSize * kSize / 50) << "trial " << trial;
    }
}

TEST_F(Picture, BackFacesShowOnlyWhereTheMaterialIsTwoSided) {
    const View view = squareView();
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), glm::pi<double>(), glm::dvec3(0.0, 1.0, 0.0));
    const glm::dmat4 mirrored = glm::scale(glm::dmat4(1.0), glm::dvec3(-1.0, 1.0, 1.0));
    const auto seen = [&](const glm::dmat4& pose, bool doubleSided) {
        auto scene = std::make_shared<Scene>();
        Material material = emitter({});
        material.emissive = glm::vec3(0.5f);
        material.doubleSided = doubleSided;
        scene->materials.push_back(material);
        place(*scene, quadMesh(0.5), 0, pose);
        return at(draw(scene, view, {}, 32, 32), 16, 16).x > 0;
    };
    EXPECT_TRUE(seen(glm::dmat4(1.0), false));
    EXPECT_FALSE(seen(turned, false));
    EXPECT_TRUE(seen(turned, true));
    EXPECT_TRUE(seen(mirrored, false)) << "a mirrored object shows its outside";
    EXPECT_FALSE(seen(turned * mirrored, false));
}

TEST_F(Picture, EveryViewFillsThePictureAndClipsNothing) {
    const auto torus = torusScene();
    View view = viewFor(*torus);
    const PixelData background = draw(nullptr, view);
    for (size_t mode = 0; mode < kViewModeNames.size(); ++mode) {
        view.mode = static_cast<ViewMode>(mode);
        const PixelData pixels = draw(torus, view);
        int covered = 0, white = 0, onTheRim = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const glm::ivec3 difference = glm::abs(at(pixels, x, y) - at(background, x, y));
                const bool model = difference.x + difference.y + difference.z > 12;
                covered += model;
                white += at(pixels, x, y) == glm::ivec3(255);
                onTheRim += model && (x == 0 || y == 0 || x == kWidth - 1 || y == kHeight - 1);
            }
        EXPECT_GT(covered, kWidth * kHeight / 6) << kViewModeNames[mode];
        EXPECT_LT(covered, kWidth * kHeight * 2 / 3) << kViewModeNames[mode];
        EXPECT_LT(white, kWidth * kHeight / 200) << kViewModeNames[mode];
        EXPECT_EQ(onTheRim, 0) << kViewModeNames[mode];
    }
}

TEST_F(Picture, SimplifiedMeshesLookTheSame) {
    const auto scene = torusScene();
    View view = viewFor(*scene);
    const PixelData full = draw(scene, view);
    renderer_->beginScene(prepareScene(scene));
    while (!renderer_->continueScene(0.001)) {
    }
    const auto drawn = [&](double pixels, PixelData& picture) {
        view.allowedError = pixels;
        renderer_->render(view, {}, kWidth, kHeight);
        picture = renderer_->readPixels();
        return renderer_->statistics().drawnTriangles;
    };
    PixelData same, near, coarse;
    EXPECT_EQ(drawn(0.0, same), 64800u);
    EXPECT_EQ(failingShare(same, full), 0.0) << "taken in by slices";
    const uint64_t nearTriangles = drawn(0.4, near), coarseTriangles = drawn(30.0, coarse);
    EXPECT_LT(nearTriangles, 40000u);
    EXPECT_LT(failingShare(near, full), 0.04);
    EXPECT_LT(coarseTriangles, nearTriangles);
    EXPECT_GT(failingShare(coarse, full), failingShare(near, full));
}

TEST_F(Picture, WhatWasShownStaysUntilTheNextSceneIsWhole) {
    const auto before = torusScene(48, 16), after = featureBoard();
    const View view = viewFor(*before);
    const PixelData shown = draw(before, view);
    renderer_->beginScene(prepareScene(after));
    bool done = false;
    for (int step = 0; !done; ++step) {
        ASSERT_LT(step, 10000);
        renderer_->render(view, {}, kWidth, kHeight);
        EXPECT_EQ(failingShare(renderer_->readPixels(), shown), 0.0) << "step " << step;
        done = renderer_->continueScene(0.0);
    }
    renderer_->render(view, {}, kWidth, kHeight);
    EXPECT_EQ(failingShare(renderer_->readPixels(), draw(after, view)), 0.0);
}

TEST_F(Picture, TheMagnifiersImageIsItsOwn) {
    const auto scene = torusScene(48, 16);
    const View view = viewFor(*scene);
    const PixelData reference = draw(scene, view);
    View near = view;
    near.mode = ViewMode::Uv;
    renderer_->render(near, touchOverlay(), 64, 64, Eye::Magnifier);
    EXPECT_EQ(failingShare(renderer_->readPixels(), reference), 0.0) << "the main eye keeps its picture";
}

TEST_F(Picture, TheProbesShadowTellsItsHeight) {
    View view = squareView();
    view.lights[0] = {{0.0, 0.0, 1.0}, glm::vec3(2.0f)};
    view.surroundings = Surroundings{};
    auto scene = std::make_shared<Scene>();
    Material material;
    material.baseColor = {0.4f, 0.4f, 0.4f, 1.0f};
    material.metallic = 0.0f;
    scene->materials.push_back(material);
    place(*scene, quadMesh(1.0), 0);
    const auto middle = [&](double height, double radius) {
        view.probe = {{0.0, 0.0, height}, radius};
        return at(draw(scene, view, {}, 65, 65), 32, 32).x;
    };
    const int lit = middle(0.1, 0.0), near = middle(0.1, 0.05), higher = middle(0.3, 0.05),
              far = middle(5.0, 0.05);
    EXPECT_LT(near, 0.75 * lit);
    EXPECT_GT(higher, near + 10);
    EXPECT_GT(far, higher + 10);
    EXPECT_NEAR(far, lit, 3);
    view.probe = {{0.0, 0.0, 0.1}, 0.05};
    EXPECT_NEAR(at(draw(scene, view, {}, 65, 65), 60, 32).x, lit, 3) << "the shadow stays near";
}

TEST_F(Picture, WhatShinesThroughIsSeenBehindItsOwnNearSide) {
    // Two parallel sheets of one two-sided mesh, the near one listed first: both tint what is behind.
    View view = squareView();
    view.background = {glm::vec3(1.0f), glm::vec3(1.0f)};
    const auto seen = [&](int sheets) {
        auto scene = std::make_shared<Scene>();
        Material material = emitter({});
        material.baseColor = {0.0f, 0.0f, 0.0f, 0.5f};
        material.emissive = glm::vec3(0.0f);
        material.alphaMode = AlphaMode::Blend;
        material.doubleSided = true;
        scene->materials.push_back(material);
        for (int i = 0; i < sheets; ++i)
            place(*scene, quadMesh(0.5), 0, glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, -0.1 * i)));
        return at(draw(scene, view, {}, 32, 32), 16, 16).x;
    };
    // Half and a quarter of white, as sRGB.
    EXPECT_NEAR(seen(1), 188, 2);
    EXPECT_NEAR(seen(2), 137, 2);
}

TEST_F(Picture, WhatIsWithinAGlassIsSeenBetweenItsFarAndItsNearSide) {
    View view = squareView();
    view.background = {glm::vec3(0.0f), glm::vec3(0.0f)};
    const auto scene = std::make_shared<Scene>();
    const auto glass = [&](const glm::dvec3& color, bool blended) {
        Material material;
        material.baseColor = {0.0f, 0.0f, 0.0f, blended ? 0.5f : 1.0f};
        material.metallic = 0.0f;
        material.emissive = glm::vec3(color);
        material.alphaMode = blended ? AlphaMode::Blend : AlphaMode::Opaque;
        material.doubleSided = true;
        scene->materials.push_back(material);
        return static_cast<int>(scene->materials.size()) - 1;
    };
    const auto seen = [&] {
        const glm::ivec3 bytes = at(draw(scene, view, {}, 33, 33), 16, 16);
        const auto linear = [](int byte) {
            const double c = byte / 255.0;
            return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
        };
        return glm::dvec3(linear(bytes.x), linear(bytes.y), linear(bytes.z));
    };
    const auto over = [](const glm::dvec3& color, const glm::dvec3& behind) {
        return 0.5 * (color + behind);
    };
    const glm::dvec3 outer(0.6, 0.0, 0.0), inner(0.0, 0.6, 0.0), core(0.0, 0.0, 0.6);
    // The inner one is listed first, and nearer than the outer one's middle.
    const int innerGlass = glass(inner, true), outerGlass = glass(outer, true), solid = glass(core, false);
    place(*scene, sphereMesh(0.1, 32, 16), innerGlass,
          glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, 0.1)));
    place(*scene, sphereMesh(0.3, 32, 16), outerGlass);
    glm::dvec3 expected = over(outer, over(inner, over(inner, over(outer, glm::dvec3(0.0)))));
    EXPECT_LT(glm::length(seen() - expected), 0.01);
    // A solid one in the inner hides the far sides of both.
    place(*scene, sphereMesh(0.05, 32, 16), solid,
          glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, 0.1)));
    EXPECT_LT(glm::length(seen() - over(outer, over(inner, core))), 0.01);
    // A pane behind them is behind them, and one in front is in front, from whichever side it is seen.
    for (const double turned : {0.0, 3.14159265358979}) {
        for (const double z : {-0.35, 0.35}) {
            place(*scene, quadMesh(0.5), innerGlass,
                  glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, z)) *
                      glm::rotate(glm::dmat4(1.0), turned, glm::dvec3(0.0, 1.0, 0.0)));
            const glm::dvec3 spheres = over(outer, over(inner, core));
            EXPECT_LT(glm::length(seen() - (z > 0.0 ? over(inner, spheres) : spheres)), 0.01) << z;
            scene->instances.pop_back();
        }
    }
}

TEST_F(Picture, DistanceFromTheOriginChangesNothing) {
    const auto near = torusScene();
    const PixelData reference = draw(near, viewFor(*near), touchOverlay());
    // A thousand kilometres away, by the node and by the fit to the workspace.
    const glm::dvec3 far(1e6, -2e6, 5e5);
    const auto moved = torusScene();
    moved->instances[0].sceneFromMesh = glm::translate(glm::dmat4(1.0), far);
    View view = viewFor(*near);
    view.workspaceFromScene.translation = -far;
    EXPECT_EQ(failingShare(draw(moved, view, touchOverlay()), reference), 0.0);
    // Eight metres off within the mesh, where floats are 0.5 um apart.
    const auto shifted = torusScene();
    for (glm::vec3& p : shifted->meshes[0].positions)
        p += glm::vec3(8.0f, -8.0f, 8.0f);
    view.workspaceFromScene.translation = -glm::dvec3(8.0, -8.0, 8.0);
    EXPECT_LT(failingShare(draw(shifted, view, touchOverlay()), reference), 0.001);
    // The whole workspace moved: camera, overlay and all.
    OrbitCamera camera = cameraFor(*near, static_cast<double>(kWidth) / kHeight);
    camera.target += far;
    Overlay overlay = touchOverlay();
    for (auto& item : overlay.spheres)
        item.centre += far;
    for (auto& item : overlay.discs)
        item.centre += far;
    for (auto& item : overlay.arrows)
        item.from += far, item.to += far;
    for (auto& item : overlay.lines)
        item.from += far, item.to += far;
    Similarity fit;
    fit.translation = far;
    EXPECT_LT(failingShare(draw(near, viewOf(camera, fit, static_cast<double>(kWidth) / kHeight), overlay),
                           reference),
              0.001);
}

TEST_F(Picture, ScaleOfTheModelChangesNothing) {
    const auto metres = torusScene();
    const PixelData reference = draw(metres, viewFor(*metres));
    for (const double factor : {1e-4, 1e4}) {
        const auto scaled = torusScene();
        for (glm::vec3& p : scaled->meshes[0].positions)
            p *= static_cast<float>(factor);
        View view = viewFor(*metres);
        view.workspaceFromScene.scale = 1.0 / factor;
        EXPECT_LT(failingShare(draw(scaled, view), reference), 0.001) << factor;
    }
}

TEST_F(Picture, NormalMapsLookTheSameWithTangentsAndWithout) {
    const auto with = torusScene();
    const PixelData reference = draw(with, viewFor(*with));
    const auto without = torusScene();
    without->meshes[0].tangents.clear();
    // Derivatives are constant over two by two pixels and faceted at triangle borders: near, not equal.
    EXPECT_LT(failingShare(draw(without, viewFor(*with)), reference), 0.10);
    const auto inverted = torusScene();
    for (glm::vec4& tangent : inverted->meshes[0].tangents)
        tangent.w = -1.0f;
    EXPECT_GT(failingShare(draw(inverted, viewFor(*with)), reference), 0.12)
        << "the comparison sees a wrong bitangent";
}

TEST_F(Picture, PosesMoveObjects) {
    const auto scene = torusScene(48, 16);
    const View view = viewFor(*scene);
    const PixelData atRest = draw(scene, view);
    const std::vector<glm::dmat4> pose{glm::translate(glm::dmat4(1.0), glm::dvec3(0.03, 0.0, 0.0))};
    renderer_->setInstancePoses(pose);
    renderer_->render(view, {}, kWidth, kHeight);
    const PixelData moved = renderer_->readPixels();
    EXPECT_GT(failingShare(moved, atRest), 0.05);
    const auto placed = torusScene(48, 16);
    placed->instances[0].sceneFromMesh = pose[0];
    EXPECT_EQ(failingShare(draw(placed, view), moved), 0.0);
    EXPECT_THROW(renderer_->setInstancePoses({}), std::invalid_argument);
}

TEST_F(Picture, BrokenPosesAndOverlaysAreLeftOut) {
    const auto scene = torusScene(48, 16);
    const View view = viewFor(*scene);
    const PixelData empty = draw(nullptr, view);
    renderer_->setScene(scene);
    const std::vector<glm::dmat4> pose{glm::dmat4(std::nan(""))};
    renderer_->setInstancePoses(pose);
    Overlay overlay;
    overlay.spheres.push_back({glm::dvec3(std::nan("")), 1.0, glm::vec4(1.0f)});
    overlay.arrows.push_back({glm::dvec3(0.0), glm::dvec3(0.0), 0.001, glm::vec4(1.0f)});
    overlay.discs.push_back({glm::dvec3(0.0), glm::dvec3(0.0), 1.0, glm::vec4(1.0f)});
    overlay.lines.push_back({glm::dvec3(0.0), glm::dvec3(INFINITY), glm::vec4(1.0f), 1.0f});
    renderer_->render(view, overlay, kWidth, kHeight);
    EXPECT_EQ(failingShare(renderer_->readPixels(), empty), 0.0);
}

TEST_F(Picture, OddSizesAreDrawn) {
    const auto scene = torusScene(48, 16);
    const View view = viewFor(*scene);
    for (const glm::ivec2 size :
         {glm::ivec2(1, 1), glm::ivec2(17, 301), glm::ivec2(641, 3), glm::ivec2(0, -5)}) {
        const PixelData pixels = draw(scene, view, touchOverlay(), size.x, size.y);
        EXPECT_EQ(pixels.width, std::max(size.x, 1));
        EXPECT_EQ(pixels.height, std::max(size.y, 1));
        EXPECT_EQ(pixels.bytes.size(),
                  size_t{4} * static_cast<size_t>(pixels.width) * static_cast<size_t>(pixels.height));
    }
}

TEST_F(Picture, SupersamplingSmoothsEdgesAndKeepsThePicture) {
    const auto scene = torusScene();
    const View view = viewFor(*scene);
    const PixelData plain = draw(scene, view);
    const PixelData smooth = renderStill(*renderer_, view, {}, kWidth, kHeight, 3);
    ASSERT_EQ(smooth.width, kWidth);
    ASSERT_EQ(smooth.height, kHeight);
    const double different = failingShare(smooth, plain);
    EXPECT_GT(different, 0.005) << "edges differ";
    EXPECT_LT(different, 0.25) << "surfaces do not";
}

TEST_F(Picture, EveryPixelIsOpaque) {
    const auto scene = featureBoard();
    const PixelData pixels = draw(scene, viewFor(*scene), touchOverlay());
    for (size_t i = 3; i < pixels.bytes.size(); i += 4)
        ASSERT_EQ(pixels.bytes[i], std::byte{255});
}

/// Raw pixels from a process of its own with this many threads.
std::vector<char> pixelsWithThreads(int threads) {
    const std::string file =
        (std::filesystem::temp_directory_path() /
         ("touchstone_pixels_" + std::to_string(::getpid()) + "_" + std::to_string(threads)))
            .string();
    const pid_t child = ::fork();
    if (child == 0) {
        ::setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
        ::unsetenv("DISPLAY");
        ::execl(RENDER_PROBE, RENDER_PROBE, "pixels", file.c_str(), static_cast<char*>(nullptr));
        ::_exit(127);
    }
    int status = -1;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0)
        << "the probe failed with " << threads << " threads";
    std::ifstream stream(file, std::ios::binary);
    std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
    stream.close();
    std::filesystem::remove(file);
    return bytes;
}

TEST(Determinism, SameBitsWithAnyNumberOfThreadsAndNoDisplay) {
    const std::vector<char> reference = pixelsWithThreads(0);
    ASSERT_EQ(reference.size(), size_t{320 * 180 * 4});
    for (const int threads : {1, 2, 3, 8})
        EXPECT_EQ(pixelsWithThreads(threads), reference) << threads;
}

TEST(NoDriver, ErrorNamesThePackage) {
    {
        // Loader and driver are chosen by the environment when the instance is made.
        const KeptEnvironment kept;
        ::setenv("VK_ICD_FILENAMES", "/nonexistent.json", 1);
        ::setenv("VK_DRIVER_FILES", "/nonexistent.json", 1);
        try {
            (void)Gpu::headless();
            ADD_FAILURE() << "there is no driver, yet a device was made";
        } catch (const Error& error) {
            EXPECT_NE(error.remedy().find("mesa-vulkan-drivers"), std::string::npos) << error.what();
        }
    }
    useLavapipe();
    GpuOptions unknown;
    unknown.device = "no such card";
    EXPECT_THROW((void)Gpu::headless(unknown), Error);
}

/// Niceness of each thread of this process, by its number.
std::map<pid_t, int> nicenesses() {
    std::map<pid_t, int> found;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
        const auto id = static_cast<pid_t>(std::stol(task.path().filename().string()));
        errno = 0; // a thread may have ended meanwhile
        if (const int niceness = getpriority(PRIO_PROCESS, static_cast<id_t>(id)); errno == 0)
            found[id] = niceness;
    }
    return found;
}

TEST(SoftwareDevice, DrawsBehindWhatIsFelt) {
    useLavapipe();
    const std::map<pid_t, int> before = nicenesses();
    const auto gpu = Gpu::headless({.device = "", .validation = false, .log = nullptr});
    ASSERT_TRUE(gpu->isSoftware());
    int started = 0;
    for (const auto& [thread, niceness] : nicenesses()) {
        if (const auto known = before.find(thread); known != before.end()) {
            EXPECT_EQ(niceness, known->second) << "the caller's thread, and those that were there";
            continue;
        }
        ++started;
        EXPECT_GE(niceness, 3) << thread;
    }
    EXPECT_GE(started, 1);
}

} // namespace
} // namespace touchstone::test::picture_test

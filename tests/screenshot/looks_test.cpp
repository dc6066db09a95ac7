// What the looks of materials must be, in numbers: energy, colours, tints, lines and points.

#include "renderer/environment.h"
#include "tests/screenshot/renderer_fixture.h"

#include <glm/gtc/color_space.hpp>

#include <functional>

namespace touchstone::test::looks_test {
namespace {

constexpr float kRadiance = 0.5f;

class Looks : public RendererFixture {
  protected:
    static constexpr int kSide = 96;

    void TearDown() override {
        renderer_->setEnvironment(nullptr);
        RendererFixture::TearDown();
    }

    static Material material(const glm::vec4& color, float metallic, float roughness) {
        Material made;
        made.baseColor = color;
        made.metallic = metallic;
        made.roughness = roughness;
        return made;
    }

    static std::shared_ptr<Scene> sceneOf(Mesh mesh, const Material& look,
                                          const glm::dmat4& pose = glm::dmat4(1.0)) {
        auto scene = std::make_shared<Scene>();
        scene->materials.push_back(look);
        place(*scene, std::move(mesh), 0, pose);
        return scene;
    }

    /// Looks at the square [-1, 1]² of z = 0, which fills the picture, with the light of every model.
    static View litView() {
        OrbitCamera camera;
        camera.sceneRadius = 2.0;
        camera.distance = 1.0 / std::tan(0.5 * camera.fovY);
        View view = viewOf(camera, {}, 1.0);
        view.background = {glm::vec3(0.0f), glm::vec3(0.0f)};
        return view;
    }

    /// The same without lamps, radiance `grey` from everywhere.
    static View furnace(float grey = kRadiance) {
        View view = litView();
        for (DirectionalLight& light : view.lights)
            light.irradiance = glm::vec3(0.0f);
        view.surroundings = {glm::vec3(grey), glm::vec3(grey), glm::vec3(grey), glm::vec3(grey), {}};
        return view;
    }

    static glm::vec3 linear(const glm::ivec3& bytes) {
        return glm::convertSRGBToLinear(glm::vec3(bytes) / 255.0f);
    }

    /// Mean linear colour of what is not the black background.
    static glm::vec3 meanOf(const PixelData& pixels) {
        glm::dvec3 sum(0.0);
        int count = 0;
        for (int y = 0; y < pixels.height; ++y)
            for (int x = 0; x < pixels.width; ++x)
                if (const glm::ivec3 bytes = at(pixels, x, y); bytes != glm::ivec3(0)) {
                    sum += glm::dvec3(linear(bytes));
                    ++count;
                }
        return glm::vec3(sum / std::max(1.0, static_cast<double>(count)));
    }

    static glm::vec3 meanOfSphere(const Material& look, const View& view) {
        return meanOf(draw(sceneOf(sphereMesh(0.9, 64, 48), look), view, {}, kSide, kSide));
    }

    static glm::vec3 middleOfQuad(const Material& look, const View& view,
                                  const glm::dmat4& pose = glm::dmat4(1.0)) {
        return linear(at(draw(sceneOf(quadMesh(0.9), look, pose), view, {}, 32, 32), 16, 16));
    }

    static int largestDifference(const PixelData& a, const PixelData& b) {
        int largest = 0;
        for (size_t i = 0; i < a.bytes.size(); ++i)
            largest = std::max(largest,
                               std::abs(std::to_integer<int>(a.bytes[i]) - std::to_integer<int>(b.bytes[i])));
        return largest;
    }

    static int drawnPixels(const PixelData& pixels) {
        int count = 0;
        for (int y = 0; y < pixels.height; ++y)
            for (int x = 0; x < pixels.width; ++x)
                count += at(pixels, x, y) != glm::ivec3(0);
        return count;
    }
};

// Failed: metal of roughness 1 sent back 0.45 of it, what Karis' fit has for single scattering.
TEST_F(Looks, AWhiteFurnaceShowsNeitherMetalNorDielectric) {
    for (const float metallic : {0.0f, 1.0f})
        for (const float roughness : {0.1f, 0.3f, 0.5f, 0.7f, 0.85f, 1.0f}) {
            // The tone mapper's toe takes 0.04 off.
            const float seen =
                meanOfSphere(material(glm::vec4(1.0f), metallic, roughness), furnace()).y + 0.04f;
            RecordProperty("metal" + std::to_string(metallic) + "_r" + std::to_string(roughness),
                           std::to_string(seen / kRadiance));
            EXPECT_NEAR(seen, kRadiance, (metallic > 0.0f ? 0.01f : 0.05f) * kRadiance)
                << "metallic " << metallic << ", roughness " << roughness;
        }
}

// Failed: 0.29 against 0.73 of a rough white dielectric.
TEST_F(Looks, GltfsDefaultMaterialIsNearlyAsBrightAsAWhiteDielectric) {
    const float metal = meanOfSphere(Material{}, litView()).y;
    const float dielectric = meanOfSphere(material(glm::vec4(1.0f), 0.0f, 1.0f), litView()).y;
    std::printf("default material %.3f, white dielectric %.3f\n", static_cast<double>(metal),
                static_cast<double>(dielectric));
    EXPECT_GT(metal, 0.85f * dielectric);
    EXPECT_LT(metal, 1.15f * dielectric);
}

TEST_F(Looks, UnlitIsTheBaseColour) {
    for (const glm::vec3& color :
         {glm::vec3(1.0f, 0.5f, 0.0f), glm::vec3(0.02f, 0.2f, 0.9f), glm::vec3(1.0f)}) {
        Material unlit = material(glm::vec4(color, 1.0f), 1.0f, 1.0f);
        unlit.unlit = true;
        unlit.emissive = glm::vec3(1.0f); // does not count
        const PixelData pixels = draw(sceneOf(sphereMesh(0.9, 32, 24), unlit), litView(), {}, kSide, kSide);
        const glm::vec3 expected = 255.0f * glm::convertLinearToSRGB(color);
        for (const glm::ivec2& pixel : {glm::ivec2(48, 48), glm::ivec2(20, 48), glm::ivec2(60, 75)})
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(at(pixels, pixel.x, pixel.y)[c], expected[c], 2.0f);
    }
}

TEST_F(Looks, SpecularGlossinessLooksAsItsMetallicCounterpart) {
    const auto glossy = [](const glm::vec3& diffuse, const glm::vec3& specular, float glossiness) {
        Material made;
        made.baseColor = glm::vec4(diffuse, 1.0f);
        made.specularGlossiness.used = true;
        made.specularGlossiness.specular = specular;
        made.specularGlossiness.glossiness = glossiness;
        return made;
    };
    const auto picture = [](const Material& look) {
        auto scene = sceneOf(sphereMesh(0.9, 64, 48), look);
        scene->images.push_back(image("look", 4, 4, 4, [](double, double) { return glm::vec4(0.5f); }));
        return draw(scene, litView(), {}, kSide, kSide);
    };
    for (const float roughness : {0.15f, 0.5f, 1.0f}) {
        const glm::vec3 gold(0.9f, 0.6f, 0.3f), blue(0.1f, 0.3f, 0.8f);
        EXPECT_LE(largestDifference(picture(glossy(glm::vec3(0.0f), gold, 1.0f - roughness)),
                                    picture(material(glm::vec4(gold, 1.0f), 1.0f, roughness))),
                  2)
            << "metal of roughness " << roughness;
        EXPECT_LE(largestDifference(picture(glossy(blue, glm::vec3(0.04f), 1.0f - roughness)),
                                    picture(material(glm::vec4(blue, 1.0f), 0.0f, roughness))),
                  4)
            << "dielectric of roughness " << roughness;
    }
    // The map's colours are sRGB, its alpha is not.
    Material mapped = glossy(glm::vec3(0.0f), glm::vec3(1.0f), 1.0f);
    mapped.specularGlossiness.texture = texture(0);
    const float half = glm::convertSRGBToLinear(glm::vec3(128.0f / 255.0f)).x;
    EXPECT_LE(largestDifference(picture(mapped),
                                picture(glossy(glm::vec3(0.0f), glm::vec3(half), 128.0f / 255.0f))),
              2);
}

// Failed: a pane of glass was blended over with a fifth of its own colour.
TEST_F(Looks, GlassTintsWhatLiesBehind) {
    View view = furnace(0.0f);
    view.background = {glm::vec3(0.8f), glm::vec3(0.8f)};
    const glm::vec3 green(0.2f, 0.8f, 0.3f);
    Material glass = material(glm::vec4(green, 1.0f), 0.0f, 0.0f);
    glass.transmission.factor = 1.0f;
    const auto expectTint = [&](const Material& look, const glm::vec3& tint, const glm::dmat4& pose) {
        const glm::vec3 seen = middleOfQuad(look, view, pose);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(seen[c], 0.96f * 0.8f * tint[c], 0.015f) << c;
    };
    expectTint(glass, green, glm::dmat4(1.0));
    // A volume takes from the light by its depth, which scales with the node: 0.2 m of 0.1 m, then 0.1 m.
    glass.baseColor = glm::vec4(1.0f);
    glass.transmission.thickness = 0.2f;
    glass.transmission.attenuationDistance = 0.1f;
    glass.transmission.attenuationColor = {1.0f, 0.5f, 0.25f};
    expectTint(glass, {1.0f, 0.25f, 0.0625f}, glm::dmat4(1.0));
    expectTint(glass, {1.0f, 0.5f, 0.25f}, glm::scale(glm::dmat4(1.0), glm::dvec3(0.5)));
    glass.transmission.thickness = 0.0f;
    expectTint(glass, glm::vec3(1.0f), glm::dmat4(1.0));
    glass.transmission.factor = 0.5f; // half of it is a white surface, which nothing lights
    expectTint(glass, glm::vec3(0.5f), glm::dmat4(1.0));
    glass.metallic = 1.0f;
    expectTint(glass, glm::vec3(0.0f), glm::dmat4(1.0));
}

TEST_F(Looks, FrostedGlassScattersTheLightFromBehind) {
    Material glass = material({1.0f, 0.2f, 0.2f, 1.0f}, 0.0f, 1.0f);
    glass.transmission.factor = 1.0f;
    View view = furnace();
    view.background = {glm::vec3(0.0f), glm::vec3(0.0f)};
    const glm::vec3 seen = middleOfQuad(glass, view);
    EXPECT_GT(seen.x, 0.75f * kRadiance);
    EXPECT_LT(seen.y, 0.5f * seen.x);
}

// Failed: sheen was black.
TEST_F(Looks, SheenShinesMostAtTheRim) {
    Material cloth = material({0.0f, 0.0f, 0.0f, 1.0f}, 0.0f, 1.0f);
    const glm::vec3 without = meanOfSphere(cloth, litView());
    cloth.sheen.color = {0.9f, 0.2f, 0.2f};
    cloth.sheen.roughness = 0.4f;
    const PixelData pixels = draw(sceneOf(sphereMesh(0.9, 64, 48), cloth), furnace(), {}, kSide, kSide);
    EXPECT_GT(linear(at(pixels, 12, 48)).x, 2.0f * linear(at(pixels, 48, 48)).x);
    const glm::vec3 with = meanOfSphere(cloth, litView());
    EXPECT_GT(with.x, without.x + 0.1f);
    EXPECT_GT(with.x, 2.0f * with.y);
    // It takes from below what it reflects: white cloth with white sheen stays within the furnace.
    Material white = material(glm::vec4(1.0f), 0.0f, 1.0f);
    white.sheen.color = glm::vec3(1.0f);
    white.sheen.roughness = 0.5f;
    EXPECT_NEAR(meanOfSphere(white, furnace()).y + 0.04f, kRadiance, 0.05f * kRadiance);
}

TEST_F(Looks, AVarnishReflectsLampsOverARoughSurface) {
    Material paint = material({0.3f, 0.02f, 0.02f, 1.0f}, 0.0f, 1.0f);
    const auto brightest = [](const Material& look) {
        const PixelData pixels = draw(sceneOf(sphereMesh(0.9, 64, 48), look), litView(), {}, kSide, kSide);
        float most = 0.0f;
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x)
                most = std::max(most, linear(at(pixels, x, y)).y);
        return most;
    };
    const float dull = brightest(paint);
    paint.clearcoat.factor = 1.0f;
    EXPECT_GT(brightest(paint), dull + 0.3f);
    Material white = material(glm::vec4(1.0f), 0.0f, 1.0f);
    white.clearcoat.factor = 1.0f;
    EXPECT_NEAR(meanOfSphere(white, furnace()).y + 0.04f, kRadiance, 0.06f * kRadiance);
}

TEST_F(Looks, TheIndexOfRefractionSetsTheReflection) {
    // Straight on, a black mirror of roughness 0.06 reflects its f0 of the furnace.
    const auto reflected = [](const std::function<void(DielectricSpecular&)>& change) {
        Material black = material({0.0f, 0.0f, 0.0f, 1.0f}, 0.0f, 0.0f);
        black.emissive = glm::vec3(0.2f); // over the tone mapper's toe
        change(black.specular);
        return (middleOfQuad(black, furnace()).y + 0.04f - 0.2f) / kRadiance;
    };
    const auto ior = [](float value) { return [value](DielectricSpecular& look) { look.ior = value; }; };
    EXPECT_NEAR(reflected([](DielectricSpecular&) {}), 0.04f, 0.01f);
    EXPECT_NEAR(reflected(ior(1.0f)), 0.0f, 0.01f);
    EXPECT_NEAR(reflected(ior(2.42f)), 0.172f, 0.02f);
    EXPECT_NEAR(reflected(ior(0.0f)), 1.0f, 0.03f) << "reflects everything";
    EXPECT_NEAR(reflected([](DielectricSpecular& look) { look.factor = 0.0f; }), 0.0f, 0.01f);
    EXPECT_NEAR(reflected([](DielectricSpecular& look) { look.color = glm::vec3(3.0f); }), 0.12f, 0.015f);
}

// Failed: nothing was drawn.
TEST_F(Looks, LinesAreDrawnInTheirColours) {
    Mesh line;
    line.positions = {{-0.5f, 0.02f, 0.0f}, {0.5f, 0.02f, 0.0f}, {0.0f, 0.9f, 0.0f}};
    line.colors = {{1.0f, 0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 1.0f, 1.0f}, glm::vec4(1.0f)};
    line.lineIndices = {0, 1};
    const auto scene = sceneOf(line, material(glm::vec4(1.0f), 1.0f, 1.0f));
    View view = litView();
    const PixelData pixels = draw(scene, view, {}, 128, 128);
    EXPECT_GE(drawnPixels(pixels), 64) << "half of the picture's width, 1.5 pixels wide";
    EXPECT_LE(drawnPixels(pixels), 132);
    const auto rowOf = [&](int x) {
        for (int y = 0; y < 128; ++y)
            if (at(pixels, x, y) != glm::ivec3(0))
                return at(pixels, x, y);
        return glm::ivec3(0);
    };
    EXPECT_GT(rowOf(34).x, 240);
    EXPECT_LT(rowOf(34).z, 80);
    EXPECT_GT(rowOf(93).z, 240);
    EXPECT_NEAR(rowOf(64).x, rowOf(64).z, 12);
    view.pixelScale = 4.0f;
    const int wide = drawnPixels(draw(scene, view, {}, 128, 128));
    EXPECT_NEAR(wide, 64 * 6, 64);
    view.mode = ViewMode::Stiffness;
    EXPECT_EQ(drawnPixels(draw(scene, view, {}, 128, 128)), 0) << "not felt";
    line.normals.assign(3, {0.0f, 0.0f, 1.0f});
    EXPECT_GT(
        drawnPixels(draw(sceneOf(line, material(glm::vec4(1.0f), 0.0f, 1.0f)), litView(), {}, 128, 128)), 63)
        << "lit";
}

TEST_F(Looks, PointsAreRoundAndCountNoTriangles) {
    Mesh points;
    points.positions = {{-0.5f, 0.0f, 0.0f}, {0.5f, 0.0f, 0.0f}, {0.0f, 5.0f, 0.0f}};
    points.pointIndices = {0, 1, 2};
    Material green = material({0.0f, 1.0f, 0.0f, 1.0f}, 1.0f, 1.0f);
    auto scene = sceneOf(points, green);
    const PixelData pixels = draw(scene, litView(), {}, 128, 128);
    EXPECT_NEAR(drawnPixels(pixels), 2 * 20, 12) << "two of five pixels across, the third is out of sight";
    EXPECT_EQ(at(pixels, 32, 64), glm::ivec3(0, 255, 0));
    EXPECT_EQ(renderer_->statistics().triangles, 0u);
    EXPECT_EQ(renderer_->statistics().drawCalls, 1u);
    View large = litView();
    large.pixelScale = 8.0f;
    EXPECT_NEAR(drawnPixels(draw(scene, large, {}, 128, 128)), 2 * 1257, 100) << "discs of 40 pixels";
    scene->materials[0].alphaMode = AlphaMode::Blend;
    scene->materials[0].baseColor.w = 0.5f;
    EXPECT_NEAR(at(draw(scene, litView(), {}, 128, 128), 32, 64).y, 188, 3);
}

TEST_F(Looks, AnEnvironmentIsTheLight) {
    Panorama sides{64, 32, {}};
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) // the right half lies at +x
            sides.texels.push_back(x < 32 ? glm::vec3(0.0f, 0.0f, 1.0f) : glm::vec3(1.0f, 0.0f, 0.0f));
    View view = furnace(0.0f);
    const Material mirror = material(glm::vec4(1.0f), 1.0f, 0.1f),
                   chalk = material(glm::vec4(1.0f), 0.0f, 1.0f);
    EXPECT_EQ(meanOfSphere(mirror, view), glm::vec3(0.0f));
    renderer_->setEnvironment(prefilter(sides));
    for (const Material& look : {mirror, chalk}) {
        const PixelData pixels = draw(sceneOf(sphereMesh(0.9, 64, 48), look), view, {}, kSide, kSide);
        const glm::vec3 left = linear(at(pixels, 16, 48)), right = linear(at(pixels, 80, 48));
        EXPECT_GT(left.z, 2.0f * left.x);
        EXPECT_GT(right.x, 2.0f * right.z);
        EXPECT_NEAR(right.x, left.z, 0.35f * right.x);
    }
    Panorama grey{64, 32, std::vector<glm::vec3>(64 * 32, glm::vec3(3.0f))};
    renderer_->setEnvironment(prefilter(grey));
    for (const float roughness : {0.1f, 0.5f, 1.0f})
        EXPECT_NEAR(meanOfSphere(material(glm::vec4(1.0f), 1.0f, roughness), view).y + 0.04f,
                    static_cast<float>(Environment::kMeanRadiance), 0.01f);
    renderer_->setEnvironment(nullptr);
    EXPECT_EQ(meanOfSphere(mirror, view), glm::vec3(0.0f)) << "and no longer";
}

} // namespace
} // namespace touchstone::test::looks_test

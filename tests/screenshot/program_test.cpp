// Haptic programs in the picture.

#include "engine/program/surface_program.h"
#include "tests/screenshot/renderer_fixture.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>

namespace touchstone::test::program_test {
namespace {

class ProgramPictures : public RendererFixture {
  protected:
    static constexpr int kSide = 128;

    static MaterialProgram programOf(const std::string& text) {
        return materialProgram(compileSurfaceProgram("test.glsl", text, {}, [] { return false; }),
                               nlohmann::json::object());
    }
    static std::string body(const std::string& text) {
        return "void touch(const in Touch before, inout Surface after) {\n" + text + "\n}\n";
    }
    /// The square [-1, 1]² of z = 0 in the mesh, grey.
    static std::shared_ptr<Scene> square(const MaterialProgram& program,
                                         const glm::dmat4& pose = glm::dmat4(1.0)) {
        auto scene = std::make_shared<Scene>();
        Material material;
        material.baseColor = {0.5f, 0.5f, 0.5f, 1.0f};
        material.metallic = 0.0f;
        material.roughness = 0.8f;
        material.haptic.program = program;
        scene->materials.push_back(material);
        place(*scene, quadMesh(1.0), 0, pose);
        return scene;
    }
    static View view() {
        OrbitCamera camera;
        camera.sceneRadius = 2.0;
        camera.distance = 1.0 / std::tan(0.5 * camera.fovY);
        return viewOf(camera, {}, 1.0);
    }
    static PixelData picture(const MaterialProgram& program, const glm::dmat4& pose = glm::dmat4(1.0)) {
        return draw(square(program, pose), view(), {}, kSide, kSide);
    }
    static int greatestDifference(const PixelData& a, const PixelData& b) {
        int greatest = 0;
        for (size_t i = 0; i < a.bytes.size(); ++i)
            greatest = std::max(
                greatest, std::abs(std::to_integer<int>(a.bytes[i]) - std::to_integer<int>(b.bytes[i])));
        return greatest;
    }
};

TEST_F(ProgramPictures, ShowTheColourOfThePlaceInMetresOfTheScene) {
    const MaterialProgram program = programOf(
        body("after.colour = before.position.x > 0.5 ? vec3(0.0, 0.8, 0.0) : vec3(0.8, 0.0, 0.0);"));
    const auto isGreen = [](const glm::ivec3& c) { return c.y > 2 * c.x; };
    const PixelData plain = picture(program);
    EXPECT_FALSE(isGreen(at(plain, 90, 64))); // x = 0.41
    EXPECT_TRUE(isGreen(at(plain, 102, 64))); // x = 0.59
    // Half as large, and moved: the origin is the mesh's, the lengths are the scene's.
    const glm::dmat4 pose = glm::translate(glm::dmat4(1.0), glm::dvec3(0.25, 0.0, 0.0)) *
                            glm::scale(glm::dmat4(1.0), glm::dvec3(0.6));
    const PixelData small = picture(program, pose);
    EXPECT_FALSE(isGreen(at(small, 106, 64))); // 0.41 of the mesh's middle
    EXPECT_TRUE(isGreen(at(small, 115, 64)));  // 0.55
}

TEST_F(ProgramPictures, ShowThePersistentTextureAsTouchHasMadeIt) {
    MaterialProgram program = programOf(body("after.colour = mix(vec3(0.0, 0.8, 0.0), vec3(0.8, 0.0, 0.0), "
                                             "before.persistent);"));
    program.texture = {.width = 64, .height = 64};
    const auto isGreen = [](const glm::ivec3& c) { return c.y > 2 * c.x; };
    const ScenePtr scene = square(program);
    const PixelData covered = draw(scene, view(), {}, kSide, kSide);
    EXPECT_FALSE(isGreen(at(covered, 40, 40)));
    EXPECT_FALSE(isGreen(at(covered, 90, 90)));
    // The upper left quarter of the texture, whose origin is the upper left of the picture.
    const std::vector<float> clean(64 * 64, 0.0f);
    const PersistentTexels quarter{.instance = 0,
                                   .textureWidth = 64,
                                   .textureHeight = 64,
                                   .width = 32,
                                   .height = 32,
                                   .values = clean.data()};
    renderer_->setTexels(quarter);
    renderer_->render(view(), {}, kSide, kSide);
    PixelData worn = renderer_->readPixels();
    EXPECT_TRUE(isGreen(at(worn, 40, 40)));
    EXPECT_FALSE(isGreen(at(worn, 90, 40)));
    EXPECT_FALSE(isGreen(at(worn, 90, 90)));
    // A program with other parameters goes on with it; textures of other sizes and instances are ignored.
    MaterialProgram edited = programOf(body("after.colour = mix(vec3(0.0, 0.7, 0.0), vec3(0.7, 0.0, 0.0), "
                                            "before.persistent);"));
    edited.texture = program.texture;
    renderer_->setPrograms({edited});
    PersistentTexels wrong = quarter;
    wrong.instance = 7;
    renderer_->setTexels(wrong);
    wrong = quarter;
    wrong.textureWidth = 32;
    renderer_->setTexels(wrong);
    wrong = quarter;
    wrong.y = 40;
    renderer_->setTexels(wrong);
    renderer_->render(view(), {}, kSide, kSide);
    worn = renderer_->readPixels();
    EXPECT_TRUE(isGreen(at(worn, 40, 40)));
    EXPECT_FALSE(isGreen(at(worn, 40, 90)));
}

TEST_F(ProgramPictures, ArePlainWhereThereIsNoResult) {
    const PixelData plain = picture({});
    for (const char* text :
         {"while (true) { after.colour.r += 1.0; }", "while (true) {}",
          "after.colour = vec3(sqrt(-1.0 - before.time));",
          "float t[2] = float[](1.0, 2.0); after.colour = vec3(t[int(before.position.x * 1e-3) + 7]);",
          "after.colour = vec3(float(1 / int(before.position.x * 1e-3)));",
          "after.force = vec3(1e38) * 1e38;"}) {
        const auto start = std::chrono::steady_clock::now();
        const PixelData drawn = picture(programOf(body(text)));
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        EXPECT_EQ(greatestDifference(drawn, plain), 0) << text;
        std::printf("%.0f ms with compiling: %s\n", 1e3 * time.count(), text);
    }
}

TEST_F(ProgramPictures, DisplacementsBendTheNormalByTheirSlope) {
    const PixelData plain = picture({});
    const PixelData displaced =
        picture(programOf(body("after.position += 0.1 * sin(9.0 * before.position.x) * before.normal;")));
    const PixelData perturbed = picture(
        programOf(body("after.normal = normalize(before.normal - 0.9 * cos(9.0 * before.position.x) * "
                       "vec3(1.0, 0.0, 0.0));")));
    EXPECT_GT(greatestDifference(displaced, plain), 20);
    EXPECT_LE(greatestDifference(displaced, perturbed), 4); // a pixel's difference quotient
}

TEST_F(ProgramPictures, FollowParametersAndKeepNoPipelineOfWhatIsGone) {
    const std::string text = "parameter float grey = 0.1; // 0..1\n" + body("after.colour = vec3(grey);");
    MaterialProgram program = programOf(text);
    renderer_->setScene(square(program));
    const auto brightness = [&] {
        renderer_->render(view(), {}, kSide, kSide);
        return at(renderer_->readPixels(), 64, 64).y;
    };
    const int dark = brightness();
    const uint64_t compiled = renderer_->statistics().pipelines;
    program.values = {{0.9}};
    renderer_->setPrograms({program});
    EXPECT_GT(brightness(), dark + 60);
    EXPECT_EQ(renderer_->statistics().pipelines, compiled); // a parameter compiles nothing
    for (int i = 0; i < 10; ++i) {
        renderer_->setPrograms({programOf(text + "// " + std::to_string(i))});
        EXPECT_EQ(brightness(), dark);
        EXPECT_EQ(renderer_->statistics().pipelines, compiled);
        EXPECT_EQ(renderer_->programProblem(program.compiled), "");
    }
    EXPECT_THROW(renderer_->setPrograms({}), std::invalid_argument);
}

/// Prints what a frame of a window takes with each program of [003] and without one.
TEST_F(ProgramPictures, OfThePaperDifferFromThePlainOne) {
    const auto scene = torusScene();
    const auto timed = [&](const MaterialProgram& program) {
        auto drawn = std::make_shared<Scene>(*scene);
        drawn->materials[0].haptic.program = program;
        const PixelData pixels = draw(drawn, viewFor(*drawn), {}, 640, 360);
        double best = 1e9;
        for (int i = 0; i < 5; ++i) {
            const auto start = std::chrono::steady_clock::now();
            renderer_->render(viewFor(*drawn), {}, 640, 360);
            (void)renderer_->readPixels();
            best = std::min(best,
                            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        }
        return std::pair(pixels, 1e3 * best);
    };
    const auto [plain, plainTime] = timed({});
    std::printf("plain: %.1f ms\n", plainTime);
    for (const char* name : {"wood.glsl", "circles.glsl", "simple_noise.glsl"}) {
        std::ifstream file(std::string(TOUCHSTONE_SOURCE) + "/assets/programs/" + name);
        const auto [drawn, time] = timed(programOf(std::string((std::istreambuf_iterator<char>(file)), {})));
        std::printf("%s: %.1f ms\n", name, time);
        EXPECT_GT(greatestDifference(drawn, plain), 20) << name;
    }
}

} // namespace
} // namespace touchstone::test::program_test

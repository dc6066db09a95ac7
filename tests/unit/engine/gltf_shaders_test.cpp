#include "engine/import/materials/gltf_shaders.h"
#include "tests/unit/engine/load_support.h"

#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>

namespace touchstone::gltf_shaders_test {
namespace {

using nlohmann::json;
using test::GltfMaker;
using test::load;
using test::warningsOf;
using test::warns;

constexpr const char* kSource = "// a program\n"
                                "parameter float depth = 0.5; // 0..2 mm: how deep\n"
                                "parameter ivec = 1;\n";
constexpr const char* kRings = "parameter float rings = 10; // 1..100 1/m: rings per metre\n"
                               "parameter vec2 friction = vec2(0.1, 0.5); // 0..2\n"
                               "parameter int kind = 1; // 0..3\n"
                               "void touch(const in Touch before, inout Surface after) {\n"
                               "    after.staticFriction = friction.x * rings + float(kind);\n"
                               "}\n";

std::vector<uint8_t> bytesOf(const std::string& text) {
    return {text.begin(), text.end()};
}

std::string dataUri(const std::string& text) {
    return "data:text/plain;base64," + test::base64(bytesOf(text));
}

GltfMaker withShader(const json& shader) {
    GltfMaker maker = GltfMaker::square();
    maker.json["extensionsUsed"] = {"TOUCHSTONE_materials_haptic"};
    json material = json::object();
    material["extensions"]["TOUCHSTONE_materials_haptic"]["shader"] = shader;
    maker.json["materials"] = {material};
    maker.primitive()["material"] = 0;
    return maker;
}

const MaterialProgram& programOf(const ScenePtr& scene) {
    return scene->materials.at(0).haptic.program;
}

/// A folder of the test's own that is removed with it.
class Folder {
  public:
    Folder() : path_(std::filesystem::temp_directory_path() / ("shaders_test_" + std::to_string(getpid()))) {
        std::filesystem::create_directories(path_);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() { std::filesystem::remove_all(path_); }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(path_ / name, std::ios::binary) << text;
    }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

TEST(GltfShaders, ADataUriABufferViewAndAFileAreTheSameProgram) {
    const ScenePtr fromUri = load(withShader({{"source", dataUri(kRings)}}));
    ASSERT_TRUE(programOf(fromUri)) << warningsOf(*fromUri);
    EXPECT_TRUE(fromUri->warnings.empty()) << warningsOf(*fromUri);

    GltfMaker maker = withShader({{"bufferView", 0}, {"name", "rings.glsl"}});
    const std::string text = kRings;
    maker.json["materials"][0]["extensions"]["TOUCHSTONE_materials_haptic"]["shader"]["bufferView"] =
        maker.addView(text.data(), text.size());
    const ScenePtr fromView = load(maker);
    ASSERT_TRUE(programOf(fromView)) << warningsOf(*fromView);
    EXPECT_EQ(programOf(fromView).compiled->source.name, "rings.glsl");
    EXPECT_TRUE(programOf(fromView).compiled->file.empty());

    const Folder folder;
    folder.write("rings.glsl", kRings);
    const ScenePtr fromFile =
        loadSceneFromMemory(withShader({{"source", "rings.glsl"}}).glb(), folder.path(), {});
    ASSERT_TRUE(programOf(fromFile)) << warningsOf(*fromFile);
    EXPECT_EQ(programOf(fromFile).compiled->file, folder.path() / "rings.glsl");
    for (const ScenePtr& scene : {fromUri, fromView, fromFile}) {
        EXPECT_EQ(programOf(scene).compiled->spirv, programOf(fromUri).compiled->spirv);
        EXPECT_EQ(programOf(scene).compiled->text, kRings);
        EXPECT_TRUE(scene->materials[0].haptic.unavailable.empty());
    }
}

TEST(GltfShaders, ValuesOfTheFileStandInPlaceOfTheDefaults) {
    const ScenePtr scene = load(
        withShader({{"source", dataUri(kRings)}, {"parameters", {{"friction", {0.25, 1}}, {"kind", 3}}}}));
    ASSERT_TRUE(programOf(scene)) << warningsOf(*scene);
    const std::vector<std::array<double, 4>> expected{{10.0}, {0.25, 1.0}, {3.0}};
    EXPECT_EQ(programOf(scene).values, expected);
}

TEST(GltfShaders, AWrongValueIsToldWithItsLineAndTheSurfaceIsPlain) {
    const auto flaw = [](const json& parameters, const std::string& line, const std::string& part) {
        const ScenePtr scene =
            load(withShader({{"source", dataUri(kRings)}, {"name", "r.glsl"}, {"parameters", parameters}}));
        EXPECT_FALSE(programOf(scene)) << parameters;
        EXPECT_NE(scene->materials[0].says.ours.program, nullptr) << "it can be corrected";
        EXPECT_TRUE(warns(*scene, ".shader", part)) << parameters << warningsOf(*scene);
        EXPECT_TRUE(warns(*scene, ".shader", "r.glsl: " + line)) << warningsOf(*scene);
        EXPECT_TRUE(warns(*scene, ".shader", "the surface is plain")) << warningsOf(*scene);
        EXPECT_EQ(scene->triangleCount(), 2u);
    };
    flaw({{"rings", 1000}}, "line 1", "out of range; give one number of 1 to 100 1/m");
    flaw({{"rings", -1}}, "line 1", "out of range");
    flaw({{"rings", "many"}}, "line 1", "is not one number");
    flaw({{"rings", nullptr}}, "line 1", "is not one number");
    flaw({{"rings", {1, 2}}}, "line 1", "is not one number");
    flaw({{"friction", 1}}, "line 2", "is not an array of 2 numbers");
    flaw({{"friction", {1, 2, 1}}}, "line 2", "is not an array of 2 numbers");
    flaw({{"friction", {1, 3}}}, "line 2", "out of range");
    flaw({{"kind", 1.5}}, "line 3", "no whole number");
    flaw({{"colour", 1}}, "declares no parameter 'colour'", "take it out of the file");
}

TEST(GltfShaders, ABrokenSourceCostsAWarningWithItsLine) {
    const auto flaw = [](const json& shader, const std::string& part) {
        const ScenePtr scene = load(withShader(shader));
        EXPECT_FALSE(programOf(scene)) << part;
        EXPECT_TRUE(warns(*scene, ".shader", part)) << warningsOf(*scene);
        EXPECT_TRUE(scene->materials[0].haptic.unavailable.contains("shader"));
        EXPECT_EQ(scene->triangleCount(), 2u);
    };
    flaw({{"source",
           dataUri("void touch(const in Touch before, inout Surface after) {\n  after.color = 1;\n}\n")}},
         "line 2");
    flaw({{"source", dataUri(kSource)}}, "line 3");
    flaw({{"source", dataUri("#include \"/etc/passwd\"\n")}}, "line 1");
    flaw({{"source", dataUri("\xff\xfe")}}, "UTF-8");
    flaw({{"source", "missing.glsl"}}, "missing.glsl");
    flaw({{"source", "../outside.glsl"}}, "..");
    flaw({{"source", "/etc/passwd"}}, "/etc/passwd");
    flaw({{"source", "http://a.b/c.glsl"}}, "http");
    flaw({{"source", "data:text/plain;base64,%%%"}}, "");
    flaw({{"bufferView", 1000}}, "bufferViews[1000]");
    flaw({{"bufferView", "first"}}, "");
}

/// `text` as a file beside the model and inside of it: the model opens, its surface is plain, and the one
/// warning has the source's name, the line and a remedy.
void expectTold(const std::string& text, const std::string& place, const std::string& problem,
                const std::string& remedy) {
    const Folder folder;
    folder.write("p.glsl", text);
    for (const json& shader :
         {json{{"source", "p.glsl"}}, json{{"source", dataUri(text)}, {"name", "p.glsl"}}}) {
        const ScenePtr scene = loadSceneFromMemory(withShader(shader).glb(), folder.path(), {});
        EXPECT_EQ(scene->triangleCount(), 2u) << "it opens";
        EXPECT_FALSE(programOf(scene)) << text;
        EXPECT_TRUE(scene->materials[0].haptic.unavailable.contains("shader"));
        EXPECT_EQ(scene->warnings.size(), 1u) << warningsOf(*scene);
        EXPECT_TRUE(warns(*scene, "materials[0]", "p.glsl: " + place + ": ")) << warningsOf(*scene);
        for (const std::string& part : {problem, remedy, std::string("the surface is plain")})
            EXPECT_TRUE(warns(*scene, ".shader", part)) << part << ": " << warningsOf(*scene);
    }
}

TEST(GltfShaders, AnInputThatDoesNotExistIsToldWithFileLineAndRemedy) {
    const std::string begin = "// one\nvoid touch(const in Touch before, inout Surface after) {\n";
    const std::string remedy = "see docs/programs.md for what a program gets";
    expectTold(begin + "    after.force *= before.temperature;\n}\n", "line 3", "temperature", remedy);
    expectTold(begin + "    after.warmth = 1.0;\n}\n", "line 3", "warmth", remedy);
    expectTold(begin + "\n    after.force *= touchstone_temperature;\n}\n", "line 4",
               "touchstone_temperature", remedy);
    expectTold(begin + "    after.force *= gl_FragCoord.x;\n}\n", "line 3", "gl_FragCoord", remedy);
    expectTold(begin + "    after.force *= temperatureAt(before.position);\n}\n", "line 3", "temperatureAt",
               remedy);
}

TEST(GltfShaders, AnIncludeOfAnythingIsToldWithFileLineAndRemedy) {
    const std::string rest = "void touch(const in Touch before, inout Surface after) {}\n";
    for (const char* name : {"\"/etc/passwd\"", "\"/dev/zero\"", "\"p.glsl\"", "\"library.glsl\"", "<math.h>",
                             "\"../../p.glsl\"", "p.glsl", ""})
        for (const char* extension : {"", "#extension GL_GOOGLE_include_directive : require"})
            expectTold(std::string(extension) + "\n#include " + name + "\n" + rest, "line 2", "#include",
                       "leave it out: the interface and the library are there by themselves");
}

TEST(GltfShaders, ASourceOfTenMegabytesIsRefusedByItsSize) {
    const Folder folder;
    folder.write("large.glsl", std::string(10u << 20, ' '));
    const ScenePtr scene =
        loadSceneFromMemory(withShader({{"source", "large.glsl"}}).glb(), folder.path(), {});
    EXPECT_FALSE(programOf(scene));
    EXPECT_TRUE(warns(*scene, ".shader", "10485760 bytes")) << warningsOf(*scene);
}

TEST(GltfShaders, APersistentTextureIsBounded) {
    const auto sized = [](const json& texture) {
        return load(withShader({{"source", dataUri(kRings)}, {"persistentTexture", texture}}));
    };
    const ScenePtr scene = sized({{"width", 256}, {"height", 128}, {"initial", 0.5}});
    ASSERT_TRUE(programOf(scene)) << warningsOf(*scene);
    EXPECT_EQ(programOf(scene).texture, (PersistentTextureSize{256, 128, 0.5f}));
    EXPECT_EQ(programOf(sized({{"width", 8}, {"height", 8}, {"initial", 5}, {"minimum", -2}})).texture,
              (PersistentTextureSize{8, 8, 5.0f, -2.0f, 5.0f}));
    const json wrong[] = {{{"width", 32768}, {"height", 32768}}, // 4 GiB of floats
                          {{"width", 0}, {"height", 1}},
                          {{"width", 1}},
                          {{"width", 1.5}, {"height", 1}},
                          {{"width", 1}, {"height", 1}, {"initial", "full"}},
                          {{"width", 1}, {"height", 1}, {"initial", 1e30}},
                          {{"width", 1}, {"height", 1}, {"minimum", 2}},
                          {{"width", 1}, {"height", 1}, {"initial", 3}, {"maximum", 2}},
                          {{"width", 1}, {"height", 1}, {"maximum", "much"}},
                          3};
    for (const json& texture : wrong) {
        const ScenePtr plain = sized(texture);
        EXPECT_FALSE(programOf(plain)) << texture;
        EXPECT_TRUE(warns(*plain, ".shader", "persistentTexture")) << warningsOf(*plain);
    }
}

TEST(GltfShaders, MaterialsOfOneSourceShareAProgramAndManySourcesAreRefused) {
    GltfMaker maker = withShader({{"source", dataUri(kRings)}, {"name", "r"}});
    json second = maker.json["materials"][0];
    second["extensions"]["TOUCHSTONE_materials_haptic"]["shader"]["parameters"]["rings"] = 20;
    maker.json["materials"].push_back(second);
    const ScenePtr scene = load(maker);
    ASSERT_TRUE(scene->materials.at(1).haptic.program) << warningsOf(*scene);
    EXPECT_EQ(scene->materials[0].haptic.program.compiled, scene->materials[1].haptic.program.compiled);

    for (size_t i = 0; i < kMaxFilePrograms + 1; ++i) {
        json other = second;
        other["extensions"]["TOUCHSTONE_materials_haptic"]["shader"] = {
            {"source", dataUri("no program " + std::to_string(i))}};
        maker.json["materials"].push_back(other);
    }
    EXPECT_TRUE(warns(*load(maker), ".shader", "more than 64 programs"));
}

TEST(GltfShaders, AChangedParameterIsWrittenAndTheDefaultIsLeftOut) {
    const ScenePtr scene = load(withShader({{"source", dataUri(kRings)}, {"parameters", {{"rings", 20}}}}));
    ASSERT_TRUE(programOf(scene)) << warningsOf(*scene);
    const auto& declared = programOf(scene).compiled->source.parameters;
    json shader = scene->materials[0].says.ours.shader;
    shader = withParameter(shader, declared[1], {0.5, 1.5});
    shader = withParameter(shader, declared[2], {2.0});
    EXPECT_EQ(shader["parameters"], (json{{"rings", 20}, {"friction", {0.5, 1.5}}, {"kind", 2}}));
    const MaterialProgram changed = materialProgram(programOf(scene).compiled, shader);
    EXPECT_EQ(changed.values[1], (std::array<double, 4>{0.5, 1.5}));
    for (const ProgramParameter& parameter : declared)
        shader = withParameter(shader, parameter, parameter.value);
    EXPECT_FALSE(shader.contains("parameters"));
}

} // namespace
} // namespace touchstone::gltf_shaders_test

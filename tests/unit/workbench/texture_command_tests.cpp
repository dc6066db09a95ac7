// Persistent textures on the command line: coverage in percent, values saved into the model, `inspect` and
// `edit` of them, and `edit` of where texture coordinates come from.

#include "tests/support/gltf_maker.h"
#include "tests/support/program.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace touchstone::test::texture_command_tests {
namespace {

using Json = nlohmann::json;

class TextureCommand : public testing::Test {
  protected:
    /// The square under plaque, as .glb or as .gltf.
    void write(const std::filesystem::path& file) {
        GltfMaker maker = GltfMaker::square();
        maker.json["extensionsUsed"] = {"TOUCHSTONE_materials_haptic"};
        const std::string text = "void touch(const in Touch before, inout Surface after) {\n"
                                 "    after.persistentChange = -1e-2 * length(before.force);\n"
                                 "    after.brush = 0.1;\n}\n";
        Json material = Json::object();
        material["extensions"]["TOUCHSTONE_materials_haptic"]["shader"] = {
            {"source", "data:text/plain;base64," + base64({text.begin(), text.end()})},
            {"name", "plaque.glsl"},
            {"persistentTexture", {{"width", 64}, {"height", 64}}}};
        maker.json["materials"] = {material};
        maker.primitive()["material"] = 0;
        if (file.extension() == ".glb") {
            writeFile(file, maker.glb());
            return;
        }
        maker.json["buffers"] = {{{"byteLength", maker.bytes.size()},
                                  {"uri", "data:application/octet-stream;base64," + base64(maker.bytes)}}};
        writeTextFile(file, maker.json.dump(2));
    }
    static ProgramResult run(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), TOUCHSTONE_BINARY);
        return runProgram(arguments);
    }
    Json touched(const std::filesystem::path& model, const std::vector<std::string>& more = {}) {
        std::vector<std::string> arguments{"touch",     model.string(),
                                           "--stroke",  "tour",
                                           "--seconds", "4",
                                           "--fit",     "workspace",
                                           "--out",     (folder_ / "ticks.csv").string(),
                                           "--json",    (folder_ / "touch.json").string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.status, 0) << result.err << result.out;
        EXPECT_NE(result.out.find("coverage "), std::string::npos) << result.out;
        return Json::parse(readFile(folder_ / "touch.json"))["persistent_textures"].at(0);
    }
    Json inspected(const std::filesystem::path& model) {
        const ProgramResult result =
            run({"inspect", model.string(), "--json", (folder_ / "i.json").string()});
        EXPECT_EQ(result.status, 0) << result.err;
        text_ = result.out;
        return Json::parse(readFile(folder_ / "i.json"))["materials"][0]["program"]["persistentTexture"];
    }

    ScratchFolder folder_;
    std::string text_;
};

TEST_F(TextureCommand, WhatTouchWearsOffIsSavedIntoTheModelAndTheNextSessionBeginsWithIt) {
    for (const char* ending : {".glb", ".gltf"}) {
        const std::filesystem::path model = folder_ / ("model" + std::string(ending)),
                                    worn = folder_ / ("worn" + std::string(ending));
        write(model);
        EXPECT_FALSE(inspected(model).contains("saved"));
        const Json first = touched(model, {"--brushed", worn.string()});
        const double left = first["left_percent"];
        EXPECT_LT(left, 99.5);
        EXPECT_NEAR(left + first["removed_percent"].get<double>(), 100.0, 1e-9);
        EXPECT_NEAR(left, 100.0 * first["mean"].get<double>(), 1e-9);
        // The same file but for its values.
        EXPECT_NE(readFile(worn).find("\"values\""), std::string::npos);
        const Json saved = inspected(worn)["saved"];
        EXPECT_NEAR(saved.at(0)["left_percent"].get<double>(), left, 1e-4);
        EXPECT_NE(text_.find("% left, as it was saved"), std::string::npos) << text_;
        // Touched again it goes on from there.
        const Json second = touched(worn);
        EXPECT_LT(second["left_percent"].get<double>(), left - 0.3);
        // An edit of the material keeps them; taken out, it begins even; another size takes them out, too.
        ASSERT_EQ(run({"edit", worn.string(), "--field", "staticFriction=0.4"}).status, 0);
        EXPECT_NEAR(inspected(worn)["saved"].at(0)["left_percent"].get<double>(), left, 1e-4);
        const std::filesystem::path other = folder_ / ("other" + std::string(ending));
        ASSERT_EQ(run({"edit", worn.string(), "--reset-field", "shader.persistentTexture.values", "--out",
                       other.string()})
                      .status,
                  0);
        EXPECT_FALSE(inspected(other).contains("saved"));
        ASSERT_EQ(run({"edit", worn.string(), "--field", "shader.persistentTexture=32,16", "--field",
                       "shader.persistentTexture.initial=0.5", "--out", other.string()})
                      .status,
                  0);
        const Json smaller = inspected(other);
        EXPECT_FALSE(smaller.contains("saved"));
        EXPECT_EQ(smaller["width"], 32);
        EXPECT_EQ(smaller["height"], 16);
        EXPECT_EQ(smaller["initial"], 0.5);
    }
}

TEST_F(TextureCommand, WrongFieldsOfTheTextureAreRefusedWithARemedy) {
    const std::filesystem::path model = folder_ / "model.glb";
    write(model);
    const std::string before = readFile(model);
    const auto refused = [&](const std::vector<std::string>& more, const std::string& says) {
        std::vector<std::string> arguments{"edit", model.string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = run(arguments);
        EXPECT_NE(result.status, 0) << says;
        EXPECT_NE((result.err + result.out).find(says), std::string::npos) << result.err << result.out;
    };
    refused({"--field", "shader.persistentTexture=4096,4"}, "out of range");
    refused({"--field", "shader.persistentTexture=4"}, "WIDTH,HEIGHT");
    refused({"--field", "shader.persistentTexture.minimum=2"}, "minimum");
    refused({"--field", "shader.persistentTexture.depth=3"}, "width, height");
    refused({"--reset-field", "shader.persistentTexture.values"}, "nothing that the file says");
    refused({"--reset-field", "shader.persistentTexture.width"}, "nothing that the file says");
    refused({"--field", "textureMapping=cone"}, "cone");
    refused({"--field", "textureMapping=sphere", "--field", "textureMapping.repeat=0.5,1"}, "repeat");
    refused({"--field", "textureMapping=sphere", "--field", "textureMapping.rotation=1,2,3,4"}, "quaternion");
    refused({"--field", "textureMapping.size=1"}, "textureMapping");
    EXPECT_TRUE(readFile(model) == before) << "nothing is written";
}

TEST_F(TextureCommand, EditSetsWhereTextureCoordinatesComeFrom) {
    const std::filesystem::path model = folder_ / "model.gltf";
    write(model);
    const auto mapping = [&] {
        const Json ours =
            Json::parse(readFile(model))["materials"][0]["extensions"]["TOUCHSTONE_materials_haptic"];
        return ours.value("textureMapping", Json());
    };
    ASSERT_EQ(run({"edit", model.string(), "--field", "textureMapping=sphere", "--field",
                   "textureMapping.repeat=4,2", "--field", "textureMapping.by=normal"})
                  .status,
              0);
    EXPECT_EQ(mapping(), (Json{{"surface", "sphere"}, {"repeat", {4, 2}}, {"by", "normal"}}));
    ASSERT_EQ(run({"edit", model.string(), "--field", "textureMapping=box"}).status, 0);
    EXPECT_EQ(mapping()["surface"], "box");
    EXPECT_EQ(mapping()["repeat"], (Json{4, 2})) << "the rest stays";
    EXPECT_EQ(run({"inspect", model.string()}).status, 0);
    ASSERT_EQ(run({"edit", model.string(), "--reset-field", "textureMapping"}).status, 0);
    EXPECT_TRUE(mapping().is_null());
}

} // namespace
} // namespace touchstone::test::texture_command_tests

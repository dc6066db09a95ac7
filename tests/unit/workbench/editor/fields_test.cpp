// The table of fields knows what the importer knows: what is set by name is read back from the file.
#include "engine/load/scene_loader.h"
#include "tests/support/gltf_maker.h"
#include "workbench/editor/haptic_fields.h"
#include "workbench/editor/material_edits.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

namespace touchstone::fields_test {
namespace {

using test::GltfMaker;

/// A square with a material and two textures; the second has a name.
std::vector<uint8_t> squareWithTextures() {
    constexpr const char* kGrey = "data:image/png;base64,"
                                  "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR42mMwNjYGAAE2AJpHI3"
                                  "MJAAAAAElFTkSuQmCC";
    GltfMaker maker = GltfMaker::square();
    maker.json["images"] = {{{"uri", kGrey}, {"name", "grey"}}};
    maker.json["textures"] = {{{"source", 0}}, {{"source", 0}, {"name", "bumps"}}};
    maker.json["materials"] = {nlohmann::json::object()};
    maker.primitive()["material"] = 0;
    return maker.glb();
}

/// A value that the field may have and that is not its default.
std::string someValue(std::string_view name) {
    if (name == "forceShading")
        return "direction";
    if (name == "sides")
        return "front";
    if (name == "representation")
        return "implicit";
    if (name.ends_with("texCoord"))
        return "1";
    if (name.ends_with("Texture"))
        return "bumps";
    return "0.25";
}

TEST(HapticFields, WhatIsSetIsSavedAndReadBack) {
    const std::vector<uint8_t> bytes = squareWithTextures();
    const ScenePtr scene = loadSceneFromMemory(bytes, ".");
    MaterialEdits edits(*scene);
    HapticStatement statement;
    for (const std::string_view name :
         {"heightTexture", "frictionTexture", "stiffnessTexture", "dampingTexture"})
        EXPECT_EQ(setHapticField(statement, *scene, name, "0"), "") << name;
    for (const std::string_view name : hapticFieldNames())
        EXPECT_EQ(setHapticField(statement, *scene, name, someValue(name)), "") << name;
    edits.change(0, statement, "all");
    const ScenePtr read = loadSceneFromMemory(withMaterials(bytes, edits.patches(), "square"), ".");
    EXPECT_EQ(read->materials[0].says.ours, statement);
    EXPECT_EQ(read->materials[0].haptic.stiffness.value, 0.25f);
    EXPECT_EQ(read->materials[0].haptic.height.value->texture.texture, 1);

    // And each taken out again gives the file that it was.
    for (const std::string_view name : hapticFieldNames())
        EXPECT_TRUE(resetHapticField(statement, name)) << name;
    EXPECT_EQ(statement, HapticStatement{});
    MaterialEdits back(*read);
    back.change(0, statement, "none");
    EXPECT_EQ(withMaterials(withMaterials(bytes, edits.patches(), "square"), back.patches(), "square"),
              bytes);
}

TEST(HapticFields, TellWhatIsWrong) {
    const Scene scene;
    HapticStatement statement;
    const auto problem = [&](std::string_view name, std::string_view value) {
        return setHapticField(statement, scene, name, value);
    };
    EXPECT_NE(problem("hardness", "1").find("is no field"), std::string::npos);
    EXPECT_NE(problem("stiffness", "hard").find("is not a number"), std::string::npos);
    EXPECT_NE(problem("stiffness", "0").find("out of range"), std::string::npos);
    EXPECT_NE(problem("stiffness", "nan").find("is not a number"), std::string::npos);
    EXPECT_NE(problem("damping", "-1").find("out of range"), std::string::npos);
    EXPECT_NE(problem("normalTextureInfluence", "1.5").find("0 to 1"), std::string::npos);
    EXPECT_NE(problem("heightTexture.scale", "0.1").find("give it one first"), std::string::npos);
    EXPECT_NE(problem("heightTexture", "0").find("none of the file's textures"), std::string::npos);
    EXPECT_NE(problem("sides", "back").find("both, front"), std::string::npos);
    EXPECT_EQ(problem("heightTexture", "none"), "");
    EXPECT_EQ(statement, HapticStatement{}) << "what is refused changes nothing";
}

TEST(HapticFields, EveryOneIsInTheSchemaTheHelpAndTheDocumentation) {
    const auto textOf = [](const std::filesystem::path& path) {
        std::ifstream stream(path);
        return std::string(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    };
    const nlohmann::json schema = nlohmann::json::parse(
        textOf(TOUCHSTONE_SOURCE "/assets/schema/TOUCHSTONE_materials_haptic.schema.json"));
    const std::string page = textOf(TOUCHSTONE_SOURCE "/docs/materials.md");
    const std::string help = hapticFieldHelp();
    size_t top = 0;
    for (const std::string_view name : hapticFieldNames()) {
        EXPECT_NE(help.find(name), std::string::npos) << name;
        if (name.find('.') != std::string_view::npos)
            continue;
        ++top;
        EXPECT_TRUE(schema["properties"].contains(name)) << name;
        EXPECT_NE(page.find("`" + std::string(name) + "`"), std::string::npos) << name;
    }
    // The editor of programs has the shader; a texture mapping is geometry, made while the model is loaded.
    const std::set<std::string> others{"extensions", "extras", "shader", "textureMapping"};
    size_t known = 0;
    for (const auto& [name, value] : schema["properties"].items())
        known += others.contains(name) ? 0 : 1;
    EXPECT_EQ(top, known) << "a field of the schema cannot be edited";
}

/// Parameters of a haptic program are fields of their own, which the patch of a save holds and no more.
TEST(HapticFields, AParameterOfAProgramIsSetCheckedSavedAndReset) {
    const ScenePtr scene = loadScene(TOUCHSTONE_ASSETS "/programs.glb");
    MaterialEdits edits(*scene);
    HapticStatement statement = edits.now(3); // circles.glsl: its file states two parameters
    EXPECT_EQ(setHapticField(statement, *scene, "shader.c1", "0.01,-0.02,0"), "");
    EXPECT_EQ(setHapticField(statement, *scene, "shader.raised", "1.5"), "");
    EXPECT_NE(setHapticField(statement, *scene, "shader.raised", "9").find("out of range"),
              std::string::npos);
    EXPECT_NE(setHapticField(statement, *scene, "shader.c1", "1").find("3 components"), std::string::npos);
    EXPECT_NE(setHapticField(statement, *scene, "shader.rings", "1").find("no such parameter"),
              std::string::npos);
    EXPECT_NE(hapticValueProblem("shader.raised", "much"), "");
    edits.change(3, statement, "parameters");
    EXPECT_EQ(edits.patches().at(3).dump(),
              R"({"shader":{"parameters":{"c1":[0.01,-0.02,0.0],"raised":1.5}}})");
    EXPECT_TRUE(resetHapticField(statement, "shader.c1"));
    EXPECT_TRUE(resetHapticField(statement, "shader.raised"));
    EXPECT_FALSE(resetHapticField(statement, "shader.rings"));
    edits.change(3, statement, "reset");
    EXPECT_TRUE(edits.patches().empty());
}

} // namespace
} // namespace touchstone::fields_test

// Haptic programs while they are edited: what compiles is felt, what does not changes nothing, both are kept
// on save.

#include "engine/core/error.h"
#include "engine/import/file/gltf_uri.h"
#include "engine/load/scene_loader.h"
#include "engine/time/seconds_now.h"
#include "haptics/recording/scene_identity.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/scene/scene_programs.h"
#include "tests/support/gltf_maker.h"
#include "tests/support/program.h"
#include "workbench/editor/haptic_fields.h"
#include "workbench/editor/material_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

namespace touchstone::test::program_editor_test {
namespace {

std::string source(const std::string& friction) {
    return "parameter float rings = 10; // 1..100 1/m: rings per metre\n"
           "parameter vec2 gloss = vec2(0.1, 0.5); // 0..2\n"
           "void touch(const in Touch before, inout Surface after) {\n"
           "    after.staticFriction = " +
           friction +
           ";\n"
           "}\n";
}
const std::string kFirst = source("0.1 + 0.001 * rings"), kSecond = source("0.6 + gloss.x"),
                  kBroken = source("colour");

class EditedPrograms : public testing::Test {
  protected:
    /// Two materials that share a program.
    void open(const nlohmann::json& shader) {
        GltfMaker maker = GltfMaker::square();
        maker.json["extensionsUsed"] = {"TOUCHSTONE_materials_haptic"};
        nlohmann::json material = nlohmann::json::object();
        material["extensions"]["TOUCHSTONE_materials_haptic"]["shader"] = shader;
        maker.json["materials"] = {material, material};
        maker.primitive()["material"] = 0;
        const std::vector<uint8_t> bytes = maker.glb();
        std::ofstream(path_, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        openAgain();
    }
    void openAgain() {
        model_.scene = loadScene(path_);
        model_.workspaceFromScene = workspaceFromScene(*model_.scene, Fit::Workspace);
        model_.haptic = compileHapticScene(*model_.scene, model_.workspaceFromScene);
        controller_.open(model_, true);
    }
    void openFile(const std::string& text) {
        writeTextFile(file_, text);
        open({{"source", "p.glsl"}, {"parameters", {{"rings", 50.0}}}});
    }
    void until(const char* what, const std::function<bool()>& holds) {
        for (int i = 0; i < 20'000 && !holds(); ++i) {
            if (auto made = controller_.update(model_)) {
                model_.haptic = made->haptic;
                if (made->scene != nullptr)
                    model_.scene = made->scene;
                edits_ = made->edits;
                hash_ = made->feltHash;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        ASSERT_TRUE(holds()) << what << ": " << program().problem << controller_.notice();
    }
    void settle() {
        until("rest", [&] {
            return !controller_.programs().pending() && !controller_.working() && !controller_.saving() &&
                   controller_.touched() == controller_.edits().revision();
        });
    }
    void type(const std::string& text) {
        controller_.programs().type(0, text);
        settle();
    }
    const EditedProgram& program() { return controller_.programs().sources().at(0); }
    /// The text that the hand runs.
    std::string felt() {
        const MaterialProgram& program = controller_.materials().at(0).haptic.program;
        return program ? program.compiled->text : "";
    }
    double rings() { return controller_.materials().at(0).haptic.program.values.at(0)[0]; }

    ScratchFolder folder_;
    std::filesystem::path path_ = folder_ / "model.glb", file_ = folder_ / "p.glsl";
    Model model_;
    MaterialController controller_;
    std::string edits_;
    uint64_t hash_ = 0;
};

TEST_F(EditedPrograms, WhatIsTypedIsFeltByAllMaterialsThatShareItAndSavedInsideTheModel) {
    open({{"source", dataUriOf(kFirst)}, {"name", "mine.glsl"}, {"parameters", {{"rings", 50.0}}}});
    ASSERT_EQ(controller_.programs().sources().size(), 1u);
    EXPECT_EQ(program().text, kFirst);
    EXPECT_FALSE(controller_.edited());
    type(kSecond);
    EXPECT_EQ(felt(), kSecond);
    EXPECT_EQ(controller_.edits().now(1).program, controller_.edits().now(0).program);
    EXPECT_EQ(rings(), 50.0) << "its values stay";
    EXPECT_EQ(program().loads, 1u);
    EXPECT_TRUE(controller_.edited());
    // Touched again from the file and these edits it is the same.
    LoadOptions options;
    options.edits = edits_;
    const ScenePtr replayed = loadScene(path_, options);
    EXPECT_EQ(feltHash(*compileHapticScene(*replayed, model_.workspaceFromScene), *replayed), hash_);

    controller_.save();
    settle();
    EXPECT_FALSE(controller_.failed()) << controller_.notice();
    EXPECT_FALSE(controller_.edited());
    const ScenePtr saved = loadScene(path_);
    ASSERT_NE(saved->materials[1].says.ours.program, nullptr);
    EXPECT_EQ(saved->materials[1].says.ours.program->text, kSecond);
    EXPECT_EQ(saved->materials[0].haptic.program.values.at(0)[0], 50.0);
}

TEST_F(EditedPrograms, ABrokenEditChangesNothingSaysWhereAndCannotBeSaved) {
    open({{"source", dataUriOf(kFirst)}, {"name", "mine.glsl"}});
    const uint64_t before = controller_.edits().revision();
    type(kBroken);
    EXPECT_EQ(controller_.edits().revision(), before);
    EXPECT_EQ(felt(), kFirst);
    EXPECT_EQ(program().line, 4u) << program().problem;
    EXPECT_NE(program().problem.find("colour"), std::string::npos) << program().problem;
    EXPECT_TRUE(controller_.edited());
    controller_.save();
    settle();
    EXPECT_TRUE(controller_.failed());
    EXPECT_NE(controller_.notice().find("mine.glsl: line 4: "), std::string::npos) << controller_.notice();
    EXPECT_EQ(loadScene(path_)->materials[0].says.ours.program->text, kFirst);
    // Outside of what the hand can run.
    type(source("texture(sampler, vec2(0.0)).x"));
    EXPECT_EQ(program().line, 4u) << program().problem;
    type("parameter float rings = 10; // 20..100\n");
    EXPECT_EQ(program().line, 1u) << program().problem;
    EXPECT_EQ(felt(), kFirst);
    controller_.programs().revert(0);
    settle();
    EXPECT_EQ(program().problem, "");
    EXPECT_FALSE(controller_.edited());
}

TEST_F(EditedPrograms, AFileThatIsSavedElsewhereReloadsAndIsNoEditOfTheModel) {
    openFile(kFirst);
    EXPECT_EQ(rings(), 50.0);
    writeTextFile(file_, kSecond);
    until("the new program", [&] { return felt() == kSecond; });
    settle();
    EXPECT_EQ(program().text, kSecond);
    EXPECT_FALSE(controller_.edited());
    EXPECT_EQ(rings(), 50.0);
    EXPECT_NE(edits_.find("data:text/plain"), std::string::npos)
        << "a recording has the source, whatever becomes of the file";
    writeTextFile(file_, kBroken);
    until("the problem", [&] { return program().line == 4; });
    EXPECT_EQ(felt(), kSecond);
    EXPECT_FALSE(controller_.edited()) << "the file has it, broken as it is";
    // As editors do it: another file of the same name.
    writeTextFile(folder_ / "new", kFirst);
    std::filesystem::rename(folder_ / "new", file_);
    until("the first program", [&] { return felt() == kFirst; });
    EXPECT_EQ(program().problem, "");
    std::filesystem::remove(file_);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    settle();
    EXPECT_EQ(felt(), kFirst);
    for (const std::string& wrong : {std::string("\xff\xfe\n"), std::string(kMaxProgramBytes + 5, ' ')}) {
        writeTextFile(file_, wrong);
        until("the problem", [&] { return !program().problem.empty(); });
        EXPECT_EQ(felt(), kFirst);
        writeTextFile(file_, kFirst);
        until("no problem", [&] { return program().problem.empty(); });
    }
}

TEST_F(EditedPrograms, WhatIsTypedIsWrittenIntoTheProgramsOwnFile) {
    openFile(kFirst);
    const std::string bytes = readFile(path_);
    type(kSecond);
    EXPECT_EQ(readFile(file_), kFirst) << "nothing is written unasked";
    EXPECT_TRUE(controller_.edited());
    controller_.save();
    settle();
    EXPECT_FALSE(controller_.failed()) << controller_.notice();
    EXPECT_EQ(readFile(file_), kSecond);
    EXPECT_TRUE(readFile(path_) == bytes) << "the model refers to it as before";
    EXPECT_FALSE(controller_.edited());
}

TEST_F(EditedPrograms, WhatIsTypedAndAFileThatChangesBesideItAreBothKept) {
    openFile(kFirst);
    type(kSecond);
    writeTextFile(file_, source("0.9"));
    until("to be told", [&] { return program().overtaken; });
    EXPECT_EQ(felt(), kSecond);
    controller_.programs().revert(0);
    until("the file's", [&] { return felt() == source("0.9"); });
    settle();
    EXPECT_FALSE(program().overtaken);
    EXPECT_FALSE(controller_.edited());
}

TEST_F(EditedPrograms, ValuesThatAreNotDeclaredForTheMomentComeBack) {
    openFile(kFirst);
    std::string other = kFirst;
    other.replace(other.find("1..100"), 6, "1..20");
    type(other);
    EXPECT_EQ(rings(), 10.0) << "50 is out of range now";
    type(kFirst);
    EXPECT_EQ(rings(), 50.0);
    // Steps of the materials go on over programs.
    HapticStatement next = controller_.edits().now(0);
    ASSERT_EQ(setHapticField(next, *model_.scene, "shader.rings", "70"), "");
    controller_.edits().change(0, next, "rings");
    controller_.edits().endGesture();
    type(kSecond);
    EXPECT_EQ(rings(), 70.0);
    controller_.edits().undo();
    settle();
    EXPECT_EQ(rings(), 50.0);
    EXPECT_EQ(felt(), kSecond) << "the text has its own undo";
    controller_.edits().redo();
    settle();
    EXPECT_EQ(rings(), 70.0);
    controller_.edits().change(0, controller_.programs().reverted(0, controller_.edits()), "as in the file");
    settle();
    EXPECT_EQ(rings(), 50.0);
    EXPECT_EQ(felt(), kFirst);
    EXPECT_FALSE(controller_.edited());
}

TEST_F(EditedPrograms, AProgramThatDidNotCompileWhenTheModelWasOpenedCanBeCorrected) {
    openFile(kBroken);
    settle();
    EXPECT_EQ(felt(), "");
    EXPECT_EQ(program().line, 4u) << program().problem;
    writeTextFile(file_, kFirst);
    until("the program", [&] { return felt() == kFirst; });
    EXPECT_EQ(rings(), 50.0);
    EXPECT_EQ(controller_.edits().now(1).program, controller_.edits().now(0).program);
    open({{"source", dataUriOf(kBroken)}});
    settle();
    EXPECT_EQ(program().line, 4u);
    type(kSecond);
    EXPECT_EQ(felt(), kSecond);
}

TEST_F(EditedPrograms, TheirCostIsMeasuredOnRequestAndAnewForEachProgram) {
    openFile(kFirst);
    EXPECT_EQ(program().cost.instructions, 0u);
    controller_.programs().measure(0);
    until("the cost", [&] { return program().cost.instructions > 0; });
    const size_t before = program().cost.instructions;
    EXPECT_GT(program().cost.ns, 0.0);
    // While touch goes on it is asked for in every frame, and waits until the program is felt.
    type(source("sin(rings) * cos(gloss.x) + fBm(before.position, 4, 0.5)"));
    controller_.programs().feltAt(controller_.touched(), secondsNow());
    EXPECT_GE(program().felt, 0.0);
    until("the cost", [&] {
        controller_.programs().measure(0);
        return program().cost.instructions > 0;
    });
    EXPECT_GT(program().cost.instructions, before);
}

TEST_F(EditedPrograms, AProgramInABufferViewThatDoesNotCompileCanBeCorrected) {
    GltfMaker maker = GltfMaker::square();
    const size_t begin = (maker.bytes.size() + 3) / 4 * 4;
    maker.bytes.resize(begin);
    maker.bytes.insert(maker.bytes.end(), kBroken.begin(), kBroken.end());
    const size_t view =
        maker.append("bufferViews", {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", kBroken.size()}});
    maker.json["extensionsUsed"] = {"TOUCHSTONE_materials_haptic"};
    nlohmann::json material = nlohmann::json::object();
    material["extensions"]["TOUCHSTONE_materials_haptic"]["shader"] = {{"bufferView", view},
                                                                       {"name", "inside.glsl"}};
    maker.json["materials"] = {material};
    maker.primitive()["material"] = 0;
    writeFile(path_, maker.glb());
    openAgain();
    settle();
    ASSERT_EQ(controller_.programs().sources().size(), 1u);
    EXPECT_EQ(program().name, "inside.glsl");
    EXPECT_EQ(program().text, kBroken);
    EXPECT_EQ(program().line, 4u) << program().problem;
    type(kSecond);
    EXPECT_EQ(felt(), kSecond);
    controller_.save();
    settle();
    EXPECT_FALSE(controller_.failed()) << controller_.notice();
    const ScenePtr saved = loadScene(path_);
    ASSERT_NE(saved->materials[0].says.ours.program, nullptr);
    EXPECT_EQ(saved->materials[0].says.ours.program->text, kSecond);
}

TEST_F(EditedPrograms, AModelThatIsSavedElsewhereTakesItsProgramAlong) {
    openFile(kFirst);
    const std::filesystem::path other = folder_ / "other";
    std::filesystem::create_directories(other);
    type(kSecond);
    controller_.saveAs(other / "copy.glb");
    settle();
    EXPECT_FALSE(controller_.failed()) << controller_.notice();
    EXPECT_EQ(readFile(other / "p.glsl"), kSecond) << "as it is felt";
    EXPECT_EQ(readFile(file_), kFirst) << "the first model's is what it was";
    const ScenePtr copy = loadScene(other / "copy.glb");
    ASSERT_NE(copy->materials[0].says.ours.program, nullptr);
    EXPECT_EQ(copy->materials[0].says.ours.program->text, kSecond);
    // From now on the editor is about the new file.
    EXPECT_FALSE(controller_.edited());
    type(source("0.9"));
    controller_.save();
    settle();
    EXPECT_EQ(readFile(other / "p.glsl"), source("0.9"));
    EXPECT_EQ(readFile(file_), kFirst);
    writeTextFile(other / "p.glsl", source("0.8"));
    until("the new file's", [&] { return felt() == source("0.8"); });
    // Another program of that name is not replaced.
    const std::filesystem::path third = folder_ / "third";
    std::filesystem::create_directories(third);
    writeTextFile(third / "p.glsl", "somebody's");
    controller_.saveAs(third / "copy.glb");
    settle();
    EXPECT_TRUE(controller_.failed());
    EXPECT_NE(controller_.notice().find("p.glsl"), std::string::npos) << controller_.notice();
    EXPECT_EQ(readFile(third / "p.glsl"), "somebody's");
    EXPECT_FALSE(std::filesystem::exists(third / "copy.glb"));
}

TEST_F(EditedPrograms, WhatTouchMadeOfATextureIsUnsavedUntilItIsSavedAndBeginsTheNextSession) {
    std::string wear = kFirst;
    wear.replace(wear.find("after.static"), 0, "after.persistentChange = -before.persistent; ");
    open({{"source", dataUriOf(wear)},
          {"name", "wear.glsl"},
          {"persistentTexture", {{"width", 40}, {"height", 33}}}});
    const std::shared_ptr<PersistentTextures> textures = persistentTextures(*model_.haptic);
    ASSERT_NE(textures, nullptr);
    const auto frame = [&] { controller_.watch(model_, textures.get()); };
    frame();
    EXPECT_FALSE(controller_.edited());
    // As a contact near the first corner makes it, whatever its object's frame is.
    const Mesh& mesh = model_.scene->meshes[0];
    BrushStroke stroke;
    stroke.point = glm::dvec3(mesh.positions[0]);
    stroke.normal = glm::dvec3(mesh.normals[0]);
    stroke.radius = 0.1;
    stroke.change = -1e-3;
    textures->queue(stroke);
    textures->applyQueued();
    ASSERT_LT(textures->at(0)->mean(), 1.0);
    frame();
    EXPECT_TRUE(controller_.edited());
    EXPECT_TRUE(controller_.texturesEdited());
    controller_.save();
    settle();
    EXPECT_FALSE(controller_.failed()) << controller_.notice();
    frame();
    EXPECT_FALSE(controller_.edited());
    const auto textureNow = [&] {
        const ScenePtr scene = loadScene(path_);
        return persistentTextures(*compileHapticScene(*scene, workspaceFromScene(*scene, Fit::Workspace)));
    };
    EXPECT_TRUE(std::ranges::equal(textureNow()->at(0)->values(), textures->at(0)->values()));
    // An edit of another field leaves them in the file.
    openAgain();
    HapticStatement next = controller_.edits().now(0);
    ASSERT_EQ(setHapticField(next, *model_.scene, "shader.rings", "70"), "");
    controller_.edits().change(0, next, "rings");
    controller_.save();
    settle();
    EXPECT_TRUE(std::ranges::equal(textureNow()->at(0)->values(), textures->at(0)->values()));
}

} // namespace
} // namespace touchstone::test::program_editor_test

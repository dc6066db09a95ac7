// Saving changes what materials feel like and nothing else.
#include "engine/core/json_number.h"
#include "engine/save/json_parts.h"
#include "engine/save/material_patch.h"
#include "tests/support/shared_files.h"
#include "tests/unit/engine/load_support.h"

#include <fstream>
#include <iterator>
#include <random>

namespace touchstone::save_test {
namespace {

using nlohmann::json;
using Bytes = std::vector<uint8_t>;
using test::GltfMaker;
using test::TemporaryFolder;

constexpr const char* kOurs = "TOUCHSTONE_materials_haptic";

Bytes bytesOf(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

Bytes bytesOf(const std::string& text) {
    return {text.begin(), text.end()};
}

std::string textOf(const Bytes& bytes) {
    return {bytes.begin(), bytes.end()};
}

uint32_t wordAt(const Bytes& bytes, size_t at) {
    return static_cast<uint32_t>(bytes[at]) | static_cast<uint32_t>(bytes[at + 1]) << 8 |
           static_cast<uint32_t>(bytes[at + 2]) << 16 | static_cast<uint32_t>(bytes[at + 3]) << 24;
}

struct Pieces {
    std::string text; ///< of the JSON
    Bytes rest;       ///< all behind it
};

Pieces piecesOf(const Bytes& bytes) {
    const std::string all = textOf(bytes);
    if (!all.starts_with("glTF"))
        return {all, {}};
    const size_t length = wordAt(bytes, 12);
    return {all.substr(20, length),
            Bytes(bytes.begin() + static_cast<std::ptrdiff_t>(20 + length), bytes.end())};
}

/// What the JSON should have become, by another way: the parsed document.
json expected(const Bytes& bytes, const MaterialPatches& patches) {
    json root = json::parse(piecesOf(bytes).text);
    if (patches.empty())
        return root;
    for (const auto& [index, patch] : patches) {
        json& material = root["materials"][index];
        material["extensions"][kOurs].merge_patch(json(patch));
        if (material["extensions"][kOurs].empty())
            material["extensions"].erase(kOurs);
        if (material["extensions"].empty())
            material.erase("extensions");
    }
    json& used = root["extensionsUsed"];
    const bool any =
        std::any_of(root["materials"].begin(), root["materials"].end(), [](const json& material) {
            return material.contains("extensions") && material["extensions"].contains(kOurs);
        });
    const auto named = std::find(used.begin(), used.end(), kOurs);
    if (any && named == used.end())
        used.push_back(kOurs);
    if (!any && named != used.end())
        used.erase(named);
    if (used.empty())
        root.erase("extensionsUsed");
    return root;
}

/// One change to every material.
MaterialPatches changeAll(const Bytes& bytes) {
    const json root = json::parse(piecesOf(bytes).text);
    MaterialPatches patches;
    const size_t count = root.contains("materials") ? root["materials"].size() : 0;
    for (size_t i = 0; i < count; ++i) {
        patches[i]["stiffness"] = jsonOf(431.0f + static_cast<float>(i));
        patches[i]["staticFriction"] = jsonOf(0.35f);
        patches[i]["damping"] = nullptr;
    }
    return patches;
}

void expectOnlyMaterialsDiffer(const Bytes& before, const std::string& name) {
    const MaterialPatches patches = changeAll(before);
    const Bytes after = withMaterials(before, patches, name);
    const Pieces old = piecesOf(before), now = piecesOf(after);
    EXPECT_EQ(now.rest, old.rest) << name << ": something besides the JSON has changed";
    EXPECT_EQ(json::parse(now.text), expected(before, patches)) << name;
    EXPECT_EQ(withMaterials(after, patches, name), after) << name << ": a second save changes the file again";
    if (old.text.size() != before.size()) {
        EXPECT_EQ(wordAt(after, 8), after.size()) << name;
        EXPECT_EQ(wordAt(after, 12) % 4, 0u) << name;
    }
    // Outside the materials and the list of extensions each byte is what it was, numbers included.
    for (const JsonPart& part : jsonParts(old.text)) {
        if (part.key == "materials" || part.key == "extensionsUsed")
            continue;
        const auto same = jsonMember(now.text, part.key);
        ASSERT_TRUE(same) << name << ": " << part.key;
        EXPECT_EQ(same->of(now.text), part.of(old.text)) << name << ": " << part.key;
    }
    // Taking the changes back gives the very file, where it had none of ours before.
    if (textOf(before).find(kOurs) == std::string::npos) {
        MaterialPatches back;
        for (const auto& [index, patch] : patches)
            back[index] = {{"stiffness", nullptr}, {"staticFriction", nullptr}};
        EXPECT_EQ(withMaterials(after, back, name), before) << name;
    }
}

TEST(Save, OurScenesDifferInTheExtensionOnly) {
    size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(TOUCHSTONE_ASSETS)) {
        if (entry.path().extension() != ".glb")
            continue;
        ++files;
        expectOnlyMaterialsDiffer(bytesOf(entry.path()), entry.path().filename());
    }
    EXPECT_GT(files, 5u);
}

TEST(Save, RealModelsDifferInTheExtensionOnly) {
    const auto models = test::modelsFolder();
    if (!models)
        GTEST_SKIP() << test::kNoModels;
    const auto files = test::gltfFilesIn(*models);
    EXPECT_GT(files.size(), 5u);
    for (const auto& file : files)
        expectOnlyMaterialsDiffer(bytesOf(file), file.filename());
}

TEST(Save, WhatIsSavedIsReadAgain) {
    GltfMaker maker = GltfMaker::square();
    maker.json["materials"] = {{{"name", "a"}}, {{"name", "b"}}};
    maker.primitive()["material"] = 1;
    MaterialPatches patches;
    patches[1] = {{"stiffness", jsonOf(812.5f)}, {"dynamicFriction", jsonOf(0.1f)}, {"sides", "front"}};
    const ScenePtr scene = loadSceneFromMemory(withMaterials(maker.glb(), patches, "square"), ".");
    const HapticMaterial& haptic = scene->materials.at(1).haptic;
    EXPECT_EQ(haptic.stiffness.value, 812.5f);
    EXPECT_EQ(haptic.dynamicFriction.value, 0.1f);
    EXPECT_EQ(haptic.sides, SideChoice::Front);
    EXPECT_FALSE(scene->materials.at(0).haptic.stiffness.value);
}

TEST(Save, FloatsAreWrittenAsShortAsTheyAreReadBack) {
    EXPECT_EQ(jsonOf(0.35f).dump(), "0.35");
    EXPECT_EQ(jsonOf(600.0f).dump(), "600");
    EXPECT_EQ(jsonOf(1e-7f).dump(), "1e-07");
    std::mt19937 random(7);
    for (int i = 0; i < 20'000; ++i) {
        const uint32_t bits = static_cast<uint32_t>(random());
        float value = 0.0f;
        std::memcpy(&value, &bits, sizeof value);
        if (!std::isfinite(value))
            continue;
        const json read = json::parse(jsonOf(value).dump());
        EXPECT_EQ(static_cast<float>(read.get<double>()), value) << jsonOf(value).dump();
    }
}

const std::string kSquare =
    R"({"asset":{"version":"2.0","extras":[1.0,1e-7,0.10000000000000000555,12345678901234567890123,-0.0]},)"
    R"("materials":[{"name":"a","pbrMetallicRoughness":{"roughnessFactor":1.00}},{ }]})";

std::string patched(const std::string& text, const MaterialPatches& patches) {
    return textOf(withMaterials(bytesOf(text), patches, "text"));
}

TEST(Save, NumbersKeepTheirDigits) {
    const std::string now = patched(kSquare, {{0, {{"damping", 2}}}});
    EXPECT_EQ(
        now,
        R"({"asset":{"version":"2.0","extras":[1.0,1e-7,0.10000000000000000555,12345678901234567890123,-0.0]},)"
        R"("materials":[{"name":"a","pbrMetallicRoughness":{"roughnessFactor":1.00},)"
        R"("extensions":{"TOUCHSTONE_materials_haptic":{"damping":2}}},{ }],)"
        R"("extensionsUsed":["TOUCHSTONE_materials_haptic"]})");
    EXPECT_EQ(patched(now, {{0, {{"damping", nullptr}}}}), kSquare);
    EXPECT_EQ(patched(kSquare, {}), kSquare);
}

TEST(Save, AnEmptyMaterialTakesAField) {
    const std::string now = patched(kSquare, {{1, {{"damping", 2}}}});
    EXPECT_NE(now.find(R"(,{"extensions":{"TOUCHSTONE_materials_haptic":{"damping":2}}}])"),
              std::string::npos)
        << now;
}

TEST(Save, OtherFieldsAndOtherExtensionsKeepTheirSpelling) {
    const std::string before =
        "\xEF\xBB\xBF{\n  \"asset\": {\"version\": \"2.0\"},\n  \"extensionsUsed\": [\"KHR_x\", "
        "\"TOUCHSTONE_materials_haptic\"],\n  \"materials\": [\n    {\n      \"extensions\": {\n        "
        "\"KHR_x\": {\"a\": 1.50},\n        \"TOUCHSTONE_materials_haptic\": {\n          \"stiffness\": "
        "600.00,\n          \"shader\": {\"source\": \"a.glsl\", \"parameters\": {\"p\": 0.250}},\n          "
        "\"heightTexture\": {\"index\": 0, \"scale\": 1.0e-3, \"extensions\": {\"KHR_texture_transform\": "
        "{\"scale\": [2.0, 2.0]}}}\n        }\n      }\n    }\n  ]\n}\n";
    const auto replaced = [&](std::string from, const std::string& to) {
        std::string text = before;
        return text.replace(text.find(from), from.size(), to);
    };
    EXPECT_EQ(patched(before, {{0, {{"stiffness", 700}}}}), replaced("600.00", "700"));
    EXPECT_EQ(patched(before, {{0, {{"heightTexture", {{"scale", 0.002}}}}}}), replaced("1.0e-3", "0.002"));
    EXPECT_EQ(patched(before, {{0, {{"damping", 1}}}}),
              replaced("}}}\n        }\n      }", "}}},\n          \"damping\": 1\n        }\n      }"));
    EXPECT_EQ(patched(before, {{0, {{"stiffness", nullptr}}}}),
              replaced("\"stiffness\": 600.00,\n          ", ""));
    // With its last field the extension goes, and with its last user its name; the other extension stays.
    const std::string bare =
        patched(before, {{0, {{"stiffness", nullptr}, {"shader", nullptr}, {"heightTexture", nullptr}}}});
    EXPECT_EQ(bare.find("TOUCHSTONE"), std::string::npos) << bare;
    EXPECT_NE(bare.find("\"KHR_x\": {\"a\": 1.50}\n"), std::string::npos) << bare;
    EXPECT_NE(bare.find("[\"KHR_x\"]"), std::string::npos) << bare;
}

TEST(Save, WrittenTwiceTheLastOneCountsAsForTheReader) {
    const std::string twice =
        R"({"asset":{"version":"2.0"},"materials":[{}],"\u006daterials":[{"extensions":{},"extensions":)"
        R"({"TOUCHSTONE_materials_haptic":{"stiffness":1,"stiffness":2}}}],"extensionsUsed":[]})";
    const json now = json::parse(patched(twice, {{0, {{"stiffness", 3}}}}));
    EXPECT_EQ(now["materials"][0]["extensions"][kOurs]["stiffness"], 3);
    EXPECT_EQ(now["extensionsUsed"], json::array({kOurs}));
    const json none = json::parse(patched(twice, {{0, {{"stiffness", nullptr}}}}));
    EXPECT_EQ(none["materials"][0], json::object());
}

TEST(Save, UnknownChunksAndWhatFollowsTheEndAreKept) {
    GltfMaker maker = GltfMaker::square();
    maker.json["materials"] = {json::object()};
    Bytes bytes = maker.glb();
    const Bytes chunk = {4, 0, 0, 0, 'X', 'Y', 'Z', 'W', 1, 2, 3, 4};
    bytes.insert(bytes.end(), chunk.begin(), chunk.end());
    bytes[8] = static_cast<uint8_t>(bytes.size());
    bytes[9] = static_cast<uint8_t>(bytes.size() >> 8);
    bytes.insert(bytes.end(), {9, 9, 9});
    const Bytes now = withMaterials(bytes, {{0, {{"damping", 2}}}}, "square");
    EXPECT_EQ(piecesOf(now).rest, piecesOf(bytes).rest);
    EXPECT_EQ(wordAt(now, 8), now.size() - 3);
    EXPECT_NO_THROW((void)loadSceneFromMemory(now, "."));
}

TEST(Save, AMaterialThatIsNotThereIsTold) {
    const Error error = test::errorOf([] { return patched(kSquare, {{2, {{"damping", 2}}}}); });
    EXPECT_EQ(error.place(), "materials[2]");
    EXPECT_TRUE(test::contains(error.problem(), "no such material"));
}

/// Whatever is wrong with a file: it is refused, or it comes out as the parsed document would.
TEST(Save, DamagedFilesAreRefusedOrPatchedRight) {
    std::mt19937 random(11);
    const std::string signs = "{}[]\",:\\ 0-e\n\xEF";
    size_t patchedFiles = 0, refused = 0;
    const std::string whole =
        R"({"asset":{"version":"2.0"},"extensionsUsed":["A","TOUCHSTONE_materials_haptic"],"materials":)"
        R"([{"name":"a","extensions":{"TOUCHSTONE_materials_haptic":{"stiffness":600.0,"damping":1}}},{}]})";
    const MaterialPatches patches = {{0, {{"stiffness", 5}, {"damping", nullptr}}},
                                     {1, {{"sides", "front"}}}};
    for (int i = 0; i < 20'000; ++i) {
        std::string text = whole;
        for (int k = 0; k <= i % 3; ++k) {
            const size_t at = random() % text.size();
            const char sign = signs[random() % signs.size()];
            if (random() % 2 == 0)
                text[at] = sign;
            else
                text.insert(at, 1, sign);
        }
        json root = json::parse(text, nullptr, false);
        try {
            const std::string now = patched(text, patches);
            ++patchedFiles;
            ASSERT_EQ(json::parse(now), expected(bytesOf(text), patches)) << text << "\n" << now;
            ASSERT_EQ(patched(now, patches), now) << text;
        } catch (const Error&) {
            ++refused;
        }
    }
    EXPECT_GT(patchedFiles, 500u);
    EXPECT_GT(refused, 500u);
}

class SaveToDisk : public testing::Test {
  protected:
    SaveToDisk() {
        GltfMaker maker = GltfMaker::square();
        maker.json["materials"] = {json::object()};
        maker.primitive()["material"] = 0;
        test::writeFile(model_, maker.glb());
        stamp_ = stampOf(bytesOf(model_));
    }
    [[nodiscard]] size_t filesInFolder() const {
        return static_cast<size_t>(std::distance(std::filesystem::directory_iterator(folder_.path()),
                                                 std::filesystem::directory_iterator()));
    }

    TemporaryFolder folder_;
    std::filesystem::path model_ = folder_.path() / "model.glb";
    FileStamp stamp_;
    const MaterialPatches patches_ = {{0, {{"damping", 2}}}};
};

TEST_F(SaveToDisk, InPlaceAndAgain) {
    namespace fs = std::filesystem;
    fs::permissions(model_, fs::perms::owner_read | fs::perms::owner_write);
    const FileStamp saved = saveMaterials(model_, stamp_, patches_, model_);
    EXPECT_EQ(saved, stampOf(bytesOf(model_)));
    EXPECT_EQ(loadScene(model_)->materials[0].haptic.damping.value, 2.0f);
    EXPECT_EQ(fs::status(model_).permissions(), fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_EQ(filesInFolder(), 1u);
    const Bytes once = bytesOf(model_);
    EXPECT_EQ(saveMaterials(model_, saved, patches_, model_), saved);
    EXPECT_EQ(bytesOf(model_), once);
}

TEST_F(SaveToDisk, ALinkIsFollowed) {
    const auto link = folder_.path() / "link.glb";
    std::filesystem::create_symlink("model.glb", link);
    (void)saveMaterials(link, stamp_, patches_, link);
    EXPECT_TRUE(std::filesystem::is_symlink(link));
    EXPECT_EQ(loadScene(model_)->materials[0].haptic.damping.value, 2.0f);
}

TEST_F(SaveToDisk, AFileThatHasChangedSinceIsLeftAlone) {
    Bytes other = bytesOf(model_);
    other.push_back(0);
    test::writeFile(model_, other);
    const Error error = test::errorOf([&] { return saveMaterials(model_, stamp_, patches_, model_); });
    EXPECT_TRUE(test::contains(error.problem(), "has changed since"));
    EXPECT_FALSE(error.remedy().empty());
    EXPECT_EQ(bytesOf(model_), other);
    EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(SaveToDisk, AnotherKindOfFileIsRefused) {
    const auto target = folder_.path() / "model.gltf";
    const Error error = test::errorOf([&] { return saveMaterials(model_, stamp_, patches_, target); });
    EXPECT_TRUE(test::contains(error.remedy(), ".glb")) << error.what();
    EXPECT_FALSE(std::filesystem::exists(target));
}

TEST_F(SaveToDisk, AFolderThatIsNotThereIsTold) {
    const auto target = folder_.path() / "none" / "model.glb";
    const Error error = test::errorOf([&] { return saveMaterials(model_, stamp_, patches_, target); });
    EXPECT_EQ(error.file(), target.string());
    EXPECT_TRUE(test::contains(error.problem(), "nothing was changed")) << error.what();
}

TEST_F(SaveToDisk, AFileThatNeedsOthersStaysBesideThem) {
    GltfMaker maker = GltfMaker::square();
    maker.json["materials"] = {json::object()};
    maker.json["buffers"] = {{{"byteLength", maker.bytes.size()}, {"uri", "square.bin"}}};
    const auto path = folder_.path() / "square.gltf";
    test::writeFile(path, maker.json.dump(2));
    test::writeFile(folder_.path() / "square.bin", maker.bytes);
    const FileStamp stamp = stampOf(bytesOf(path));
    std::filesystem::create_directory(folder_.path() / "other");
    const auto elsewhere = folder_.path() / "other" / "square.gltf";
    const Error error = test::errorOf([&] { return saveMaterials(path, stamp, patches_, elsewhere); });
    EXPECT_TRUE(test::contains(error.problem(), "square.bin")) << error.what();
    EXPECT_FALSE(std::filesystem::exists(elsewhere));
    const auto beside = folder_.path() / "copy.gltf";
    (void)saveMaterials(path, stamp, patches_, beside);
    EXPECT_EQ(loadScene(beside)->materials[0].haptic.damping.value, 2.0f);
    EXPECT_EQ(bytesOf(folder_.path() / "square.bin"), maker.bytes);
}

} // namespace
} // namespace touchstone::save_test

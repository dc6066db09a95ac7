#include "tests/unit/engine/load_support.h"

namespace touchstone::gltf_validation_test {
namespace {

using nlohmann::json;
using test::contains;
using test::GltfMaker;
using test::load;
using test::warns;

Error errorOfBytes(std::vector<uint8_t> bytes) {
    return test::errorOf([&] { return loadSceneFromMemory(std::move(bytes), "."); });
}

Error errorOfText(const std::string& text) {
    return errorOfBytes({text.begin(), text.end()});
}

TEST(GltfFiles, WhatIsNoGltfSaysSo) {
    EXPECT_TRUE(
        contains(test::errorOf([] { return loadScene("/nonexistent.glb"); }).problem(), "no such file"));
    EXPECT_TRUE(contains(test::errorOf([] { return loadScene("/tmp"); }).problem(), "not a file"));
    EXPECT_TRUE(contains(test::errorOf([] { return loadScene("/dev/zero"); }).problem(), "not a file"));
    EXPECT_TRUE(contains(errorOfText("").problem(), "empty"));
    EXPECT_TRUE(contains(errorOfText("solid teapot\n").problem(), "not a glTF file"));
    EXPECT_TRUE(contains(errorOfText("[1, 2]").problem(), "not an object"));
    EXPECT_TRUE(contains(errorOfText("{\"asset\": {\"version\": \"2.0\"}").problem(),
                         "not a glTF file, or a damaged one"));
    EXPECT_TRUE(contains(errorOfText("{}").problem(), "'asset' is missing"));
    EXPECT_TRUE(contains(errorOfText("{\"asset\": {\"version\": \"3.0\"}}").problem(), "version \"3.0\""));
    EXPECT_TRUE(
        contains(errorOfText("{\"asset\": {\"version\": \"2.0\", \"x\": \"\xFF\"}}").problem(), "UTF-8"));
    for (const Error& error : {errorOfText(""), errorOfText("x"), errorOfText("{}")})
        EXPECT_FALSE(error.remedy().empty());
}

TEST(GltfFiles, AByteOrderMarkDoesNoHarm) {
    const std::string text = "\xEF\xBB\xBF{\"asset\": {\"version\": \"2.0\"}}";
    const ScenePtr scene = loadSceneFromMemory({text.begin(), text.end()}, ".");
    EXPECT_FALSE(scene->touchable());
    EXPECT_TRUE(warns(*scene, "", "byte order mark"));
}

TEST(GltfFiles, AGlbCutOffAnywhereIsRefused) {
    const std::vector<uint8_t> whole = GltfMaker::square().glb();
    for (size_t length = 0; length < whole.size(); ++length)
        EXPECT_FALSE(errorOfBytes({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)})
                         .problem()
                         .empty())
            << length;
    EXPECT_TRUE(contains(errorOfBytes({whole.begin(), whole.end() - 4}).problem(), "truncated"));
}

TEST(GltfFiles, AGlbWhoseHeaderWasMendedAfterTheCutIsRefusedToo) {
    const std::vector<uint8_t> whole = GltfMaker::square().glb();
    for (size_t length = 20; length < whole.size(); ++length) {
        std::vector<uint8_t> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
        for (size_t i = 0; i < 4; ++i)
            cut[8 + i] = static_cast<uint8_t>(length >> (8 * i));
        EXPECT_FALSE(errorOfBytes(cut).problem().empty()) << length;
    }
}

TEST(GltfFiles, GlbChunksAreChecked) {
    std::vector<uint8_t> bytes = GltfMaker::square().glb();
    bytes[4] = 1;
    EXPECT_TRUE(contains(errorOfBytes(bytes).problem(), "GLB version 1"));
    bytes = GltfMaker::square().glb();
    bytes[16] = 'X';
    EXPECT_TRUE(contains(errorOfBytes(bytes).problem(), "first GLB chunk"));
    bytes = GltfMaker::square().glb();
    bytes[15] = 0xFF;
    EXPECT_TRUE(contains(errorOfBytes(bytes).problem(), "beyond the end"));
    bytes = GltfMaker::square().glb();
    bytes.insert(bytes.end(), {1, 2, 3});
    EXPECT_TRUE(warns(*loadSceneFromMemory(bytes, "."), "header", "ignored"));
}

TEST(GltfLimits, NestingAndNumbersOfValuesAreBounded) {
    const std::string deep(100'000, '['), head = "{\"asset\": {\"version\": \"2.0\"}, \"extras\": ";
    EXPECT_TRUE(contains(errorOfText(head + deep).problem(), "nested"));
    std::string many = head + "[";
    for (int i = 0; i < 2'100'000; ++i)
        many += "0,0,";
    EXPECT_TRUE(contains(errorOfText(many + "0]}").problem(), "values"));
    GltfMaker maker = GltfMaker::square();
    json nodes = json::array();
    for (int i = 0; i < 400'001; ++i)
        nodes.push_back(json::object());
    maker.json["nodes"] = nodes;
    EXPECT_TRUE(contains(test::loadError(maker).problem(), "limit"));
}

TEST(GltfLimits, CountsThatTheFileCannotHoldAreRefused) {
    GltfMaker maker = GltfMaker::square();
    maker.json["accessors"][0] = {
        {"componentType", 5126}, {"count", 2147483647}, {"type", "VEC3"}}; // zeros, 24 GB of them
    EXPECT_REFUSED(maker, "meshes[0].primitives[0].attributes.POSITION", "would expand");

    GltfMaker repeated = GltfMaker::square(); // many primitives on one accessor
    const size_t big = repeated.addAccessor<float>(std::vector<float>(300'000, 0.5f), "VEC3");
    json primitives = json::array();
    for (int i = 0; i < 5000; ++i)
        primitives.push_back({{"attributes", {{"POSITION", big}}}});
    repeated.json["meshes"][0]["primitives"] = primitives;
    EXPECT_TRUE(contains(test::loadError(repeated).problem(), "would expand"));
}

TEST(GltfLimits, MaterialsTextAndPlacedTrianglesAreBounded) {
    GltfMaker maker = GltfMaker::square();
    json materials = json::array();
    for (int i = 0; i < 65'537; ++i)
        materials.push_back(json::object());
    maker.json["materials"] = materials;
    EXPECT_REFUSED(maker, "materials", "limit");

    maker = GltfMaker::square();
    maker.json["extras"] = std::string((64u << 20) + 1, 'x');
    EXPECT_REFUSED(maker, "", "MiB of text");

    maker = GltfMaker::square();
    std::vector<uint8_t> indices;
    for (int i = 0; i < 3000; ++i)
        indices.insert(indices.end(), {0, 1, 2});
    maker.primitive()["indices"] = maker.addAccessor<uint8_t>(indices, "SCALAR");
    for (int i = 0; i < 2000; ++i)
        maker.append("nodes", {{"mesh", 0}});
    maker.json.erase("scenes");
    EXPECT_TRUE(contains(test::loadError(maker).problem(), "triangles"));
}

TEST(GltfValidation, EveryRangeIsChecked) {
    const auto refuse = [](const char* pointer, const json& value, const std::string& place,
                           const std::string& why) {
        GltfMaker maker = GltfMaker::square();
        maker.json[json::json_pointer(pointer)] = value;
        EXPECT_REFUSED(maker, place, why);
    };
    refuse("/accessors/0/count", 5, "accessors[0]", "reads to byte 60 of a buffer view of 48");
    refuse("/accessors/0/count", -1, "accessors[0].count", "out of range");
    refuse("/accessors/0/count", 1e18, "accessors[0].count", "integer");
    refuse("/accessors/0/count", 18446744073709551615ull, "accessors[0].count", "out of range");
    refuse("/accessors/0/count", "4", "accessors[0].count", "should be an integer but is a string");
    refuse("/accessors/0/byteOffset", 4, "accessors[0]", "reads to byte 52");
    refuse("/accessors/0/byteOffset", 9007199254740991, "accessors[0]", "reads to byte");
    refuse("/accessors/0/byteOffset", 9223372036854775807, "accessors[0].byteOffset", "out of range");
    refuse("/accessors/0/bufferView", 4, "accessors[0].bufferView", "bufferViews[4]");
    refuse("/accessors/0/bufferView", -1, "accessors[0].bufferView", "bufferViews[-1]");
    refuse("/accessors/0/componentType", 5124, "accessors[0].componentType", "no component type");
    refuse("/accessors/0/type", "VEC5", "accessors[0].type", "no accessor type");
    refuse("/accessors/0/type", "MAT4", "accessors[0]", "reads to byte 256");
    refuse("/bufferViews/0/byteLength", 100000, "bufferViews[0]", "reaches to byte 100000");
    refuse("/bufferViews/0/byteOffset", 9007199254740991, "bufferViews[0]", "reaches to byte");
    refuse("/bufferViews/0/buffer", 1, "bufferViews[0].buffer", "buffers[1]");
    refuse("/bufferViews/0/byteStride", 8, "accessors[0]", "byteStride is 8");
    refuse("/bufferViews/0/byteStride", -4, "bufferViews[0].byteStride", "out of range");
    refuse("/bufferViews/0/byteStride", 256, "accessors[0]", "reads to byte 780");
    refuse("/bufferViews/0/byteStride", 2147483647, "accessors[0]", "reads to byte");
    refuse("/bufferViews/0/byteStride", 252, "accessors[0]", "reads to byte 768");
    refuse("/meshes/0/primitives/0/attributes/POSITION", 99, "meshes[0].primitives[0].attributes.POSITION",
           "accessors[99]");
    refuse("/meshes/0/primitives/0/indices", 99, "meshes[0].primitives[0].indices", "accessors[99]");
    refuse("/meshes/0/primitives/0/mode", 7, "meshes[0].primitives[0].mode", "out of range");
    refuse("/meshes/0/primitives", json::object(), "meshes[0].primitives", "should be an array");
    refuse("/nodes/0/mesh", 1, "nodes[0].mesh", "meshes[1]");
    refuse("/nodes/0/mesh", 0.5, "nodes[0].mesh", "integer");
    refuse("/nodes/0/children", {7}, "nodes[0].children[0]", "nodes[7]");
    refuse("/nodes/0/translation", {1, 2}, "nodes[0].translation", "3 numbers but holds 2");
    refuse("/nodes/0/translation", {1, 2, "3"}, "nodes[0].translation", "number");
    refuse("/scenes/0/nodes/0", 1, "scenes[0].nodes[0]", "nodes[1]");
    refuse("/scene", 1, "scene", "scenes[1]");
}

TEST(GltfValidation, UnknownRequiredExtensionsAreNamed) {
    GltfMaker maker = GltfMaker::square();
    maker.json["extensionsUsed"] = maker.json["extensionsRequired"] = {"EXT_from_the_future"};
    EXPECT_REFUSED(maker, "extensionsRequired", "EXT_from_the_future");
    maker.json.erase("extensionsRequired");
    EXPECT_TRUE(warns(*load(maker), "extensionsUsed", "EXT_from_the_future is not supported"));
    EXPECT_EQ(load(maker)->warnings.size(), 1u); // optional: one warning
    maker.json["extensionsUsed"] = maker.json["extensionsRequired"] = {"KHR_materials_iridescence"};
    EXPECT_TRUE(warns(*load(maker), "extensionsRequired", "KHR_materials_iridescence"));
    maker.json["extensionsUsed"] = maker.json["extensionsRequired"] = {"KHR_materials_clearcoat"};
    EXPECT_TRUE(load(maker)->warnings.empty());
    maker.json["extensionsRequired"] = {3};
    EXPECT_REFUSED(maker, "extensionsRequired[0]", "string");
}

TEST(GltfValidation, BrokenCamerasAndLightsCostNoGeometry) {
    GltfMaker maker = GltfMaker::square();
    maker.json["cameras"] = {{{"type", "nonsense"}}};
    maker.json["nodes"][0]["camera"] = 5;
    maker.json["extensionsUsed"] = {"KHR_lights_punctual"};
    maker.json["extensions"]["KHR_lights_punctual"]["lights"] = 3;
    EXPECT_EQ(load(maker)->triangleCount(), 2u);
}

TEST(GltfValidation, BuffersWithoutDataCostOnlyWhatReadsThem) {
    GltfMaker maker = GltfMaker::square();
    const std::string text = [&] {
        json gltf = maker.json;
        gltf["buffers"] = {{{"byteLength", maker.bytes.size()}}};
        return gltf.dump();
    }();
    const ScenePtr scene = loadSceneFromMemory({text.begin(), text.end()}, ".");
    EXPECT_FALSE(scene->touchable());
    EXPECT_TRUE(warns(*scene, "meshes[0].primitives[0]", "without data"));
}

TEST(GltfValidation, DeclaredBoundsThatDoNotHoldAreTold) {
    GltfMaker maker = GltfMaker::square();
    maker.json["accessors"][0]["min"] = {0, 0, 0};
    maker.json["accessors"][0]["max"] = {1, 0.5, 0};
    const ScenePtr scene = load(maker);
    EXPECT_TRUE(warns(*scene, "accessors[0].max", "does not hold"));
    EXPECT_FALSE(warns(*scene, "accessors[0].min", ""));
    EXPECT_EQ(scene->bounds.high.y, 1.0); // the bounds are ours
}

/// Section 3.6.2.5: min and max are those of the values with the sparse ones in place.
TEST(GltfValidation, DeclaredBoundsNeedNotHoldForValuesThatAreReplaced) {
    GltfMaker maker = GltfMaker::square();
    maker.json["accessors"][0]["bufferView"] = [&] {
        const float base[] = {0, 0, 0, 9, -9, 0, NAN, INFINITY, 0, 0, 1, 0};
        return maker.addView(base, sizeof base);
    }();
    const auto replace = [&](std::vector<uint8_t> which, std::vector<float> instead) {
        maker.json["accessors"][0]["sparse"] = {
            {"count", which.size()},
            {"indices", {{"bufferView", maker.addView(which.data(), which.size())}, {"componentType", 5121}}},
            {"values", {{"bufferView", maker.addView(instead.data(), instead.size() * sizeof(float))}}}};
    };
    replace({1, 2}, {1, 0, 0, 1, 1, 0});
    const ScenePtr scene = load(maker);
    EXPECT_TRUE(scene->warnings.empty()) << test::warningsOf(*scene);
    EXPECT_EQ(scene->bounds.high, glm::dvec3(1, 1, 0));
    replace({1, 2}, {1, 0, 0, 1, 2, 0});
    EXPECT_TRUE(warns(*load(maker), "accessors[0].max", "does not hold"));
}

} // namespace
} // namespace touchstone::gltf_validation_test

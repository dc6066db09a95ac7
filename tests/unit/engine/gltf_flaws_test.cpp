// What the specification forbids and does not make the geometry wrong: each loads with one warning of its
// own.
#include "tests/unit/engine/load_support.h"

#include <functional>

namespace touchstone::gltf_flaws_test {
namespace {

using nlohmann::json;
using test::GltfMaker;
using test::load;
using test::warns;

/// The square with `change` shows both of its triangles, and one warning more than without it, which is
/// `says`.
void expectOneWarning(const std::function<void(GltfMaker&)>& change, const std::string& place,
                      const std::string& says) {
    GltfMaker maker = GltfMaker::square();
    ASSERT_TRUE(load(maker)->warnings.empty()) << test::warningsOf(*load(maker));
    change(maker);
    const ScenePtr scene = load(maker);
    EXPECT_EQ(scene->triangleCount(), 2u) << place;
    EXPECT_EQ(scene->bounds.high, glm::dvec3(1, 1, 0)) << place;
    EXPECT_TRUE(warns(*scene, place, says)) << place << " " << says << ":\n" << test::warningsOf(*scene);
    EXPECT_EQ(scene->warnings.size(), 1u) << place << " " << says << ":\n" << test::warningsOf(*scene);
}

void expectOneWarningAt(const char* pointer, const json& value, const std::string& place,
                        const std::string& says) {
    expectOneWarning([&](GltfMaker& maker) { maker.json[json::json_pointer(pointer)] = value; }, place, says);
}

TEST(GltfFlaws, WhatDoesNotMatterIsMendedAndTold) {
    for (const char* array :
         {"samplers", "textures", "images", "materials", "animations", "cameras", "skins"})
        expectOneWarningAt((std::string("/") + array).c_str(), json::array(), array, "");
    expectOneWarningAt("/samplers", json::object(), "samplers",
                       "should be an array but is an object; it is ignored");
    expectOneWarningAt("/materials", {nullptr}, "materials[0]",
                       "should be an object but is null; it is left out");
    expectOneWarningAt("/textures", {3}, "textures[0]", "should be an object");
    expectOneWarningAt("/textures", {{{"source", 4}}}, "textures[0].source", "images[4]");
    expectOneWarningAt("/samplers", {{{"wrapS", "round"}}}, "samplers[0].wrapS", "should be an integer");
    expectOneWarningAt("/nodes/0/name", 3, "nodes[0].name", "should be a string");
    expectOneWarningAt("/meshes/0/primitives/0/material", 0, "meshes[0].primitives[0].material",
                       "materials[0]");
    expectOneWarningAt("/materials", {{{"doubleSided", 1}}}, "materials[0].doubleSided",
                       "should be true or false");
    expectOneWarningAt("/materials", {{{"pbrMetallicRoughness", 1}}}, "materials[0].pbrMetallicRoughness",
                       "should be an object");
    expectOneWarningAt("/nodes/0/extensions", 5, "nodes[0].extensions", "should be an object");
    expectOneWarningAt("/extensions", 5, "extensions", "should be an object");
    expectOneWarningAt("/extensionsUsed", "one", "extensionsUsed", "should be an array");
    expectOneWarningAt("/accessors/1/min", "low", "accessors[1].min", "should be an array");
    expectOneWarningAt("/nodes/0/rotation", {0, 0, 0, 1.5}, "nodes[0].rotation", "normalised");
    expectOneWarningAt("/nodes/0/childrn", 5, "nodes[0].childrn", "is not a property of glTF");
    expectOneWarningAt("/buffer", 5, "buffer", "is not a property of glTF");
    expectOneWarning([](GltfMaker& maker) { maker.json["scenes"] = json::array(); }, "scenes", "is empty");
}

TEST(GltfFlaws, EmptyThingsAreNoFaults) {
    expectOneWarning(
        [](GltfMaker& maker) {
            maker.append("bufferViews", {{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 0}});
        },
        "bufferViews[4]", "has no bytes");
    expectOneWarning(
        [](GltfMaker& maker) {
            maker.append("accessors",
                         {{"bufferView", 0}, {"componentType", 5126}, {"count", 0}, {"type", "SCALAR"}});
        },
        "accessors[4]", "has no elements");
    expectOneWarning(
        [](GltfMaker& maker) {
            maker.append("meshes", {{"primitives", json::array()}});
        },
        "meshes[1].primitives", "is empty");
    expectOneWarning(
        [](GltfMaker& maker) {
            maker.append("meshes", {{"name", "nothing"}});
        },
        "meshes[1]", "has no primitives");
    expectOneWarning(
        [](GltfMaker& maker) {
            maker.append("scenes", {{"nodes", json::array()}});
        },
        "scenes[1].nodes", "is empty");
    for (const char* type : {"SCALAR", "VEC3"}) { // no vertices, no indices, no sparse replacements
        GltfMaker maker = GltfMaker::square();
        maker.append("accessors", {{"bufferView", 3}, {"componentType", 5123}, {"count", 0}, {"type", type}});
        maker.primitive()[type == std::string("SCALAR") ? "indices" : "attributes"] =
            type == std::string("SCALAR") ? json(4) : json{{"POSITION", 4}};
        EXPECT_FALSE(load(maker)->touchable());
    }
    GltfMaker sparse = GltfMaker::square();
    sparse.json["accessors"][0]["sparse"] = {{"count", 0},
                                             {"indices", {{"bufferView", 3}, {"componentType", 5123}}},
                                             {"values", {{"bufferView", 3}}}};
    EXPECT_EQ(load(sparse)->triangleCount(), 2u);
    GltfMaker times = GltfMaker::square();
    times.append("accessors", {{"componentType", 5126}, {"count", 0}, {"type", "SCALAR"}});
    times.append("accessors", {{"componentType", 5126}, {"count", 0}, {"type", "VEC3"}});
    times.json["animations"] = {
        {{"samplers", {{{"input", 4}, {"output", 5}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}}};
    EXPECT_MENDED(times, "animations[0].samplers[0].input", "has no keys");
}

TEST(GltfFlaws, AnEmptyBufferIsNoFault) {
    GltfMaker maker = GltfMaker::square();
    maker.json["buffers"] = {{{"byteLength", maker.bytes.size()}},
                             {{"byteLength", 0}, {"uri", "data:application/octet-stream;base64,"}}};
    EXPECT_MENDED(maker, "buffers[1]", "has no bytes");
    EXPECT_EQ(load(maker)->warnings.size(), 1u);
}

TEST(GltfFlaws, IntegersMayBeWrittenWithAFraction) {
    GltfMaker maker = GltfMaker::square();
    const std::function<void(json&)> spell = [&](json& value) {
        if (value.is_number_integer())
            value = value.get<double>();
        if (value.is_structured())
            for (json& child : value)
                spell(child);
    };
    maker.json["materials"] = {{{"normalTexture", {{"index", 0}, {"texCoord", 0}}}}};
    maker.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
    maker.json["samplers"] = {{{"wrapS", 33071}, {"magFilter", 9728}}};
    maker.json["images"] = {{{"uri", "none.png"}}};
    maker.primitive()["material"] = 0;
    maker.json["scene"] = 0;
    maker.json["buffers"] = {{{"byteLength", maker.bytes.size()}}};
    const ScenePtr whole = load(maker);
    spell(maker.json);
    EXPECT_NE(maker.json.dump().find("5126.0"), std::string::npos) << maker.json;
    const ScenePtr fraction = load(maker);
    EXPECT_EQ(fraction->meshes.at(0).indices, whole->meshes.at(0).indices);
    EXPECT_EQ(fraction->meshes[0].positions, whole->meshes[0].positions);
    EXPECT_EQ(fraction->materials.at(0).normalTexture.texture, whole->materials.at(0).normalTexture.texture);
    EXPECT_EQ(test::warningsOf(*fraction), test::warningsOf(*whole));
    maker.json["accessors"][0]["count"] = 4.5;
    EXPECT_REFUSED(maker, "accessors[0].count", "should be an integer but is the number 4.5");
}

TEST(GltfFlaws, LayoutsThatAreForbiddenAreTold) {
    expectOneWarning(
        [](GltfMaker& maker) {
            maker.append("accessors",
                         {{"byteOffset", 8}, {"componentType", 5126}, {"count", 1}, {"type", "SCALAR"}});
        },
        "accessors[4].byteOffset", "without a bufferView");
    expectOneWarningAt("/bufferViews/0/target", 34963, "bufferViews[0].target", "is for indices, but");
    expectOneWarningAt("/bufferViews/3/target", 34962, "bufferViews[3].target",
                       "is for vertex attributes, but");
    expectOneWarningAt("/bufferViews/3/target", 1, "bufferViews[3].target", "1 is no target");
    expectOneWarningAt("/bufferViews/0/byteStride", 0, "bufferViews[0].byteStride", "is 0");
    expectOneWarning(
        [](GltfMaker& maker) {
            const uint16_t spread[] = {0, 0, 1, 0, 2, 0, 0, 0, 2, 0, 3, 0};
            maker.json["accessors"][3]["bufferView"] = maker.addView(spread, sizeof spread, 4);
        },
        "bufferViews[4].byteStride", "is given for indices");
    const auto strided = [](size_t stride, size_t bytes) {
        return [=](GltfMaker& maker) {
            std::vector<uint8_t> data(bytes, 0);
            const float square[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
            for (size_t i = 0; i < 4; ++i)
                std::memcpy(&data[i * stride], &square[3 * i], 12);
            maker.json["accessors"][0]["bufferView"] = maker.addView(data.data(), data.size(), stride);
        };
    };
    expectOneWarning(strided(256, 780), "bufferViews[4].byteStride", "multiple of four from 4 to 252");
    expectOneWarning(strided(14, 54), "bufferViews[4].byteStride", "multiple of four from 4 to 252");
    expectOneWarning(
        [](GltfMaker& maker) {
            const float value = 1.0f;
            maker.addView(&value, 4, 16);
        },
        "bufferViews[4].byteStride", "is larger than the buffer view");
    expectOneWarning(
        [](GltfMaker& maker) {
            const uint8_t bytes[8] = {};
            maker.append("accessors", {{"bufferView", maker.addView(bytes, 8)},
                                       {"byteOffset", 2},
                                       {"componentType", 5126},
                                       {"count", 1},
                                       {"type", "SCALAR"}});
        },
        "accessors[4].byteOffset", "no multiple of the components' size");
    expectOneWarning(
        [](GltfMaker& maker) {
            maker.primitive()["attributes"]["TEXCOORD_1"] = maker.append(
                "accessors", {{"bufferView", 2}, {"componentType", 5126}, {"count", 4}, {"type", "VEC2"}});
        },
        "bufferViews[2]", "without a byteStride");
    expectOneWarningAt("/accessors/3/normalized", true, "meshes[0].primitives[0].indices", "normalised");
    expectOneWarning(
        [](GltfMaker& maker) {
            maker.append("accessors",
                         {{"componentType", 5126}, {"count", 1}, {"type", "VEC2"}, {"normalized", true}});
        },
        "accessors[4]", "normalised, which floats");
}

TEST(GltfFlaws, AttributesOfForbiddenFormatsAreTold) {
    for (const char* bound : {"min", "max"})
        expectOneWarning([&](GltfMaker& maker) { maker.json["accessors"][0].erase(bound); },
                         "meshes[0].primitives[0].attributes.POSITION", "without the min and max");
    expectOneWarning(
        [](GltfMaker& maker) {
            maker.primitive()["attributes"]["POSITION"] =
                maker.addAccessor<uint32_t>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
            maker.json["accessors"][4]["min"] = {0, 0, 0};
            maker.json["accessors"][4]["max"] = {1, 1, 0};
        },
        "meshes[0].primitives[0].attributes.POSITION", "component type 5125");
    for (const char* name : {"TEXCOORD_0", "TEXCOORD_1"})
        expectOneWarning(
            [&](GltfMaker& maker) {
                maker.primitive()["attributes"][name] =
                    maker.addAccessor<uint32_t>({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2");
            },
            std::string("attributes.") + name, "component type 5125");
    expectOneWarning(
        [](GltfMaker& maker) {
            maker.primitive()["attributes"]["_STIFFNESS"] =
                maker.addAccessor<uint32_t>({1, 2, 3, 4}, "SCALAR");
        },
        "attributes._STIFFNESS", "unsigned 32-bit");
    expectOneWarning([](GltfMaker& maker) { maker.primitive()["attributes"]["TEXCOORD"] = 2; },
                     "attributes.TEXCOORD", "is not an attribute that glTF defines");
    GltfMaker quantized = GltfMaker::square(); // what the extension allows is no flaw
    quantized.json["accessors"][0] = quantized.json["accessors"][quantized.addAccessor<int16_t>(
        {0, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0, 0}, "VEC4")];
    quantized.json["accessors"][0]["type"] = "VEC3";
    quantized.json["bufferViews"][4]["byteStride"] = 8;
    quantized.json["accessors"].erase(4);
    quantized.json["accessors"][0]["min"] = {0, 0, 0};
    quantized.json["accessors"][0]["max"] = {1, 1, 0};
    EXPECT_MENDED(quantized, "attributes.POSITION", "component type 5122");
    quantized.json["extensionsUsed"] = quantized.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    EXPECT_TRUE(load(quantized)->warnings.empty()) << test::warningsOf(*load(quantized));
}

TEST(GltfFlaws, SparseIndicesThatDoNotIncreaseAreTold) {
    expectOneWarning(
        [](GltfMaker& maker) {
            const uint8_t which[] = {1, 1};
            const float instead[] = {9, 9, 9, 1, 0, 0};
            maker.json["accessors"][0]["sparse"] = {
                {"count", 2},
                {"indices", {{"bufferView", maker.addView(which, 2)}, {"componentType", 5121}}},
                {"values", {{"bufferView", maker.addView(instead, 24)}}}};
            maker.json["accessors"][0].erase("max"); // the first value is larger
            maker.json["accessors"][0]["max"] = {9, 9, 9};
        },
        "accessors[0].sparse.indices", "do not increase");
}

TEST(GltfFlaws, GlbChunksOutOfPlaceAreTold) {
    const std::vector<uint8_t> whole = GltfMaker::square().glb();
    const size_t jsonEnd = 20 + (whole[12] | whole[13] << 8 | whole[14] << 16);
    using Bytes = std::vector<uint8_t>;
    const Bytes head(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(jsonEnd));
    const Bytes binary(whole.begin() + static_cast<std::ptrdiff_t>(jsonEnd), whole.end());
    const Bytes unknown = {4, 0, 0, 0, 'X', 'T', 'R', 'A', 1, 2, 3, 4};
    const auto loaded = [&](std::initializer_list<Bytes> parts) {
        Bytes all = head;
        for (const Bytes& part : parts)
            all.insert(all.end(), part.begin(), part.end());
        for (size_t i = 0; i < 4; ++i)
            all[8 + i] = static_cast<uint8_t>(all.size() >> (8 * i));
        const ScenePtr scene = loadSceneFromMemory(all, ".");
        EXPECT_EQ(scene->triangleCount(), 2u);
        return scene;
    };
    const Bytes again(whole.begin() + 12, whole.begin() + static_cast<std::ptrdiff_t>(jsonEnd));
    EXPECT_TRUE(loaded({binary})->warnings.empty());
    EXPECT_TRUE(warns(*loaded({binary, unknown}), "chunks[2]", "unknown type"));
    EXPECT_TRUE(warns(*loaded({unknown, binary}), "chunks[2]", "belongs directly after the JSON"));
    EXPECT_TRUE(warns(*loaded({binary, binary}), "chunks[2]", "second binary chunk"));
    EXPECT_TRUE(warns(*loaded({binary, again}), "chunks[2]", "second JSON chunk"));
    EXPECT_TRUE(warns(*loaded({binary, {5, 0, 0, 0, 'X', 'T', 'R', 'A', 1, 2, 3, 4, 5}}), "chunks[2]",
                      "no multiple of four"));
}

TEST(GltfFlaws, PropertiesNamedTwiceAreTold) {
    std::string text =
        R"({"asset": {"version": "2.0", "version": "2.0"}, "extras": {"a": 1, "b": {"a": 2}}})";
    ScenePtr scene = loadSceneFromMemory({text.begin(), text.end()}, ".");
    EXPECT_TRUE(warns(*scene, "", "two properties \"version\""));
    EXPECT_FALSE(warns(*scene, "", "\"a\""));
}

TEST(GltfFlaws, ThousandsOfOneKindAreOneWarning) {
    GltfMaker maker = GltfMaker::square();
    for (int i = 0; i < 3000; ++i)
        maker.append("nodes", {{"name", i}, {"colour", "red"}});
    const ScenePtr scene = load(maker);
    ASSERT_EQ(scene->warnings.size(), 2u) << test::warningsOf(*scene);
    EXPECT_TRUE(
        warns(*scene, "nodes[1].name", "(also nodes[2].name, nodes[3].name, nodes[4].name and 2996 more)"))
        << test::warningsOf(*scene);
    EXPECT_TRUE(warns(*scene, "nodes[4].colour", "is not a property"));
}

TEST(GltfExtensions, WhatIsMissedIsOneWarningEachThatSaysWhatIsLost) {
    for (const auto& [name, loss] : {std::pair{"KHR_lights_punctual", "lamps"},
                                     {"KHR_texture_basisu", "textures are left out"},
                                     {"KHR_animation_pointer", "only nodes"},
                                     {"KHR_materials_iridescence", "simpler"},
                                     {"KHR_materials_variants", "cannot be switched"},
                                     {"MPEG_scene_interactivity", "does not react"},
                                     {"MPEG_haptic", "not played"},
                                     {"VENDOR_unheard_of", "what it adds is left out"}})
        expectOneWarningAt("/extensionsUsed", {name}, "extensionsUsed", loss);
    for (const char* name : {"KHR_lights_punctual", "KHR_texture_basisu", "KHR_materials_iridescence",
                             "KHR_animation_pointer", "MPEG_scene_interactivity"})
        expectOneWarning(
            [&](GltfMaker& maker) {
                maker.json["extensionsUsed"] = maker.json["extensionsRequired"] = {name};
            },
            "extensionsRequired", name);
    for (const char* name : {"KHR_node_visibility", "VENDOR_unheard_of"}) {
        GltfMaker maker = GltfMaker::square();
        maker.json["extensionsUsed"] = maker.json["extensionsRequired"] = {name};
        EXPECT_REFUSED(maker, "extensionsRequired", name);
    }
    for (const char* name : {"KHR_mesh_quantization", "TOUCHSTONE_materials_haptic", "KHR_xmp_json_ld"}) {
        GltfMaker maker = GltfMaker::square();
        maker.json["extensionsUsed"] = {name};
        EXPECT_TRUE(load(maker)->warnings.empty()) << name;
    }
}

TEST(GltfExtensions, UndeclaredOnesAreTold) {
    expectOneWarning(
        [](GltfMaker& maker) {
            maker.json["nodes"][0]["extensions"]["KHR_xmp_json_ld"] = {{"packet", 0}};
        },
        "extensions", "KHR_xmp_json_ld is used but not named in extensionsUsed");
    expectOneWarning([](GltfMaker& maker) { maker.json["extensionsRequired"] = {"KHR_mesh_quantization"}; },
                     "extensionsRequired", "is required but not named");
    GltfMaker extras = GltfMaker::square(); // nobody's business
    extras.json["extras"]["extensions"]["VENDOR_a"] = 1;
    EXPECT_TRUE(load(extras)->warnings.empty());
}

} // namespace
} // namespace touchstone::gltf_flaws_test

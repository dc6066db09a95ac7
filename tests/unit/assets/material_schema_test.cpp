#include "assets/scenes.h"
#include "engine/core/error.h"
#include "engine/load/scene_loader.h"
#include "engine/scene/haptic_numbers.h"
#include "tests/support/gltf_maker.h"
#include "tests/unit/assets/glb_reader.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <functional>
#include <set>
#include <string>

namespace touchstone::assets {
namespace {

using nlohmann::json;

json schema() {
    std::ifstream in(std::string(TOUCHSTONE_SOURCE) +
                     "/assets/schema/TOUCHSTONE_materials_haptic.schema.json");
    return json::parse(in);
}

bool hasType(const json& value, const std::string& type) {
    if (type == "object")
        return value.is_object();
    if (type == "array")
        return value.is_array();
    if (type == "string")
        return value.is_string();
    if (type == "integer")
        return value.is_number_integer();
    return type == "number" && value.is_number();
}

/// As much of JSON Schema as ours uses. Returns the first complaint, or nothing.
std::string complaint(const json& root, const json& rule, const json& value, const std::string& place) {
    if (rule.contains("$ref"))
        return complaint(root, root.at(json::json_pointer(rule["$ref"].get<std::string>().substr(1))), value,
                         place);
    if (rule.contains("type") && !hasType(value, rule["type"]))
        return place + " is not " + rule["type"].dump();
    if (rule.contains("enum") &&
        std::find(rule["enum"].begin(), rule["enum"].end(), value) == rule["enum"].end())
        return place + " is none of " + rule["enum"].dump();
    if (rule.contains("minimum") && value < rule["minimum"])
        return place + " is too small";
    if (rule.contains("maximum") && value > rule["maximum"])
        return place + " is too large";
    if (rule.contains("exclusiveMinimum") && value <= rule["exclusiveMinimum"])
        return place + " is too small";
    for (const json& name : rule.value("required", json::array()))
        if (!value.contains(name))
            return place + " misses " + name.dump();
    if (rule.contains("oneOf")) {
        int met = 0;
        for (const json& choice : rule["oneOf"])
            met += complaint(root, choice, value, place).empty() ? 1 : 0;
        if (met != 1)
            return place + " meets " + std::to_string(met) + " of " + rule["oneOf"].dump();
    }
    if (value.is_array()) {
        if (value.size() < rule.value("minItems", size_t{0}) ||
            value.size() > rule.value("maxItems", value.size()))
            return place + " has " + std::to_string(value.size()) + " items";
        for (size_t i = 0; rule.contains("items") && i < value.size(); ++i)
            if (std::string found = complaint(root, rule["items"], value[i], place + std::to_string(i));
                !found.empty())
                return found;
    }
    if (!value.is_object())
        return {};
    for (const auto& [name, field] : value.items()) {
        const bool known = rule.contains("properties") && rule["properties"].contains(name);
        if (!known && !rule.value("additionalProperties", true))
            return place + " has an unknown field " + name;
        if (!known)
            continue;
        const std::string found = complaint(root, rule["properties"][name], field, place + "." + name);
        if (!found.empty())
            return found;
    }
    return {};
}

std::string complaint(const json& value) {
    const json root = schema();
    return complaint(root, root, value, "material");
}

/// Every rule in the schema: the root, and what stands in properties and definitions below it.
void eachRule(const json& rule, const std::string& place,
              const std::function<void(const json&, const std::string&)>& visit) {
    visit(rule, place);
    for (const char* group : {"properties", "$defs"})
        if (rule.contains(group))
            for (const auto& [name, inner] : rule[group].items())
                eachRule(inner, place + "/" + name, visit);
}

TEST(MaterialSchema, SaysNothingThatTheTestsDoNotCheckAndLeavesNoObjectOpen) {
    const std::set<std::string> checked{"type",    "enum",     "minimum",     "maximum",
                                        "$ref",    "required", "properties",  "exclusiveMinimum",
                                        "$schema", "$id",      "title",       "additionalProperties",
                                        "$defs",   "default",  "description", "oneOf",
                                        "items",   "minItems", "maxItems"};
    int rules = 0;
    eachRule(schema(), "", [&](const json& rule, const std::string& place) {
        ++rules;
        for (const auto& [keyword, value] : rule.items())
            EXPECT_TRUE(checked.contains(keyword)) << place << " " << keyword;
        if (rule.contains("properties")) {
            EXPECT_FALSE(rule.value("additionalProperties", true)) << place;
        }
        if (rule.contains("default")) {
            EXPECT_EQ(complaint(schema(), rule, rule["default"], place), "");
        }
    });
    EXPECT_GT(rules, 25);
}

TEST(MaterialSchema, HasEveryNumberOfTheTableWithItsRange) {
    const json properties = schema()["properties"];
    for (const HapticNumber& number : hapticNumbers()) {
        const std::string name(number.name);
        ASSERT_TRUE(properties.contains(name)) << name;
        const json& rule = properties[name];
        EXPECT_EQ(rule["type"], "number") << name;
        EXPECT_EQ(rule.contains("exclusiveMinimum") ? rule["exclusiveMinimum"] : rule["minimum"],
                  std::min(number.least, 0.0f))
            << name;
        EXPECT_EQ(rule.contains("exclusiveMinimum"), number.least > 0.0f) << name;
        EXPECT_EQ(rule.contains("maximum"), number.most < kLargestHapticNumber) << name;
    }
}

TEST(MaterialSchema, HoldsForEveryMaterialOfOurScenes) {
    int materials = 0;
    for (const SceneFile& scene : allScenes()) {
        const json gltf = test::GlbReader(scene.bytes).json();
        for (const json& material : gltf["materials"]) {
            if (!material.contains("extensions") ||
                !material["extensions"].contains("TOUCHSTONE_materials_haptic"))
                continue;
            EXPECT_EQ(complaint(material["extensions"]["TOUCHSTONE_materials_haptic"]), "") << scene.name;
            EXPECT_NE(gltf["extensionsUsed"].dump().find("TOUCHSTONE_materials_haptic"), std::string::npos);
            ++materials;
        }
    }
    EXPECT_EQ(materials, 45)
        << "ten swatches, three effects, three that breathe, two doughnuts, a panel, a virtual bump, a "
           "field torus, 15 with programs, four whose images are mapped, and five of cloth and jelly";
}

constexpr const char* kEveryField = R"({"stiffness": 500, "damping": 0, "retardationTime": 0.001,
    "deformationRadius": 0.01, "deformationStiffness": 300, "deformationLinear": -1, "deformationQuadratic": 0,
    "relaxationTime": 0.1,
    "staticFriction": 0.5, "dynamicFriction": 0.4, "viscousFriction": 1, "normalTextureInfluence": 0.5,
    "heightTexture": {"index": 0, "texCoord": 1, "scale": 0.001, "midLevel": 0},
    "frictionTexture": {"index": 1, "min": 0.1, "max": 2}, "stiffnessTexture": {"index": 1},
    "dampingTexture": {"index": 1, "extensions": {"KHR_texture_transform": {}}}, "forceShading": "twoPass",
    "representation": "implicit", "voxelSize": 0.001, "fieldError": 0.0001, "noiseAmplitude": 0.001,
    "noiseWavelength": 0.01, "noiseSeed": 3, "latticeAmplitude": 0, "latticeWavelength": 0.02, "shader": {"source":
    "data:text/plain,parameter%20float%20a%20%3D%201%3B%20//%200..2%0Avoid%20touch(const%20in%20Touch%20before%2C%20inout%20Surface%20after)%20%7B%20after.damping%20%3D%20a%3B%20%7D%0A",
    "parameters": {"a": 1}, "name": "wood", "persistentTexture": {"width": 2, "height": 3, "initial": 0.5,
    "values": [{"node": 0, "surface": 0, "data": "data:application/zlib;base64,eJxjYGCwZ8CCARBWAXs="}]}},
    "textureMapping": {"surface": "cylinder", "by": "normal", "repeat": [2, 0.5], "rotation": [0, 0, 0, 1]},
    "sides": "front", "extras": 3})";
constexpr const char* kWrong[] = {
    R"({"stiffness": 0})",
    R"({"stiffness": "hard"})",
    R"({"stiffness": null})",
    R"({"damping": -1})",
    R"({"damping": [1]})",
    R"({"staticFriction": -0.1})",
    R"({"dynamicFriction": -0.1})",
    R"({"viscousFriction": -0.1})",
    R"({"normalTextureInfluence": 1.5})",
    R"({"normalTextureInfluence": -0.5})",
    R"({"heightTexture": 0})",
    R"({"heightTexture": {"index": 0}})",
    R"({"heightTexture": {"scale": 0.001}})",
    R"({"heightTexture": {"index": -1, "scale": 0.001}})",
    R"({"heightTexture": {"index": 0, "scale": "1 mm"}})",
    R"({"heightTexture": {"index": 0, "scale": 0.001, "midLevel": 1.1}})",
    R"({"heightTexture": {"index": 0, "scale": 0.001, "strength": 1}})",
    R"({"frictionTexture": {"index": 0.5}})",
    R"({"frictionTexture": {"index": 0, "texCoord": -1}})",
    R"({"frictionTexture": {"min": 0.5}})",
    R"({"stiffnessTexture": {"index": 0, "min": -0.5}})",
    R"({"dampingTexture": {"index": 0, "max": -0.5}})",
    R"({"dampingTexture": {"index": 0, "scale": 2}})",
    R"({"forceShading": "phong"})",
    R"({"forceShading": 1})",
    R"({"representation": "voxels"})",
    R"({"representation": "implicit", "voxelSize": 0})",
    R"({"representation": "implicit", "fieldError": 0})",
    R"({"representation": "implicit", "noiseAmplitude": -0.001})",
    R"({"representation": "implicit", "noiseSeed": 1e9})",
    R"({"representation": "implicit", "latticeWavelength": 0})",
    R"({"sides": "back"})",
    R"({"textureMapping": {"surface": "cone"}})",
    R"({"textureMapping": {"repeat": [1]}})",
    R"({"textureMapping": {"rotation": [0, 0, 0, "1"]}})",
    R"({"shader": {}})",
    R"({"shader": "wood.glsl"})",
    R"({"shader": {"source": 1}})",
    R"({"shader": {"source": "wood.glsl", "bufferView": 0}})",
    R"({"shader": {"bufferView": -1}})",
    R"({"shader": {"source": "a", "persistentTexture": {"width": 2}}})",
    R"({"shader": {"source": "a", "persistentTexture": {"width": 2, "height": 4096}}})",
    R"({"shader": {"source": "a", "persistentTexture": {"width": 2, "height": 2, "values": [{"node": 0}]}}})",
    R"({"shader": {"source": "wood.glsl", "parameters": 3}})",
    R"({"shader": {"source": "wood.glsl", "language": "c"}})",
    R"({"friction": 0.5})",
    R"(7)"};

TEST(MaterialSchema, AcceptsEveryFieldAndRefusesWhatIsWrong) {
    const json every = json::parse(kEveryField);
    EXPECT_EQ(complaint(every), "");
    const json rules = schema();
    for (const auto& [name, rule] : rules["properties"].items())
        EXPECT_TRUE(name == "extensions" || every.contains(name)) << name;
    for (const char* wrong : kWrong)
        EXPECT_NE(complaint(json::parse(wrong)), "") << wrong;
}

/// What the loader says to a material with this haptic object: its refusal, or its warnings about the object.
std::string loaderSays(const json& haptic) {
    touchstone::test::GltfMaker maker = touchstone::test::GltfMaker::square();
    // One grey pixel.
    maker.json["images"] = {{{"uri", "data:image/png;base64,"
                                     "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR42mMwNjYGAAE2A"
                                     "JpHI3MJAAAAAElFTkSuQmCC"}}};
    maker.json["textures"] = {{{"source", 0}}, {{"source", 0}}};
    maker.json["extensionsUsed"] = {"TOUCHSTONE_materials_haptic"};
    maker.json["materials"] = {{{"name", "m"}}};
    maker.json["materials"][0]["extensions"]["TOUCHSTONE_materials_haptic"] = haptic;
    maker.primitive()["material"] = 0;
    maker.primitive()["attributes"]["TEXCOORD_1"] = maker.primitive()["attributes"]["TEXCOORD_0"];
    try {
        std::string said;
        const ScenePtr scene = loadSceneFromMemory(maker.glb(), ".", {});
        for (const Warning& warning : scene->warnings)
            if (warning.message.find("not yet available") == std::string::npos)
                said += warning.place + " " + warning.message;
        return said;
    } catch (const Error& refusal) {
        return refusal.what();
    }
}

TEST(MaterialSchema, TheLoaderAgreesWithIt) {
    EXPECT_EQ(loaderSays(json::parse(kEveryField)), "");
    for (const char* wrong : kWrong) {
        const std::string said = loaderSays(json::parse(wrong));
        EXPECT_NE(said.find("TOUCHSTONE_materials_haptic"), std::string::npos) << wrong << ": " << said;
    }
}

TEST(MaterialSchema, OurScenesLoadWithoutAWarning) {
    for (const SceneFile& file : allScenes()) {
        const ScenePtr scene = loadScene(std::string(TOUCHSTONE_ASSETS) + "/" + file.name);
        for (const Warning& warning : scene->warnings)
            if (file.name != "materials.glb" || !warning.message.starts_with("holds points or lines"))
                ADD_FAILURE() << file.name << ": " << warning.place << " " << warning.message;
    }
}

TEST(MaterialSchema, EveryFieldIsExplained) {
    std::ifstream in(std::string(TOUCHSTONE_SOURCE) + "/docs/materials.md");
    const std::string page{std::istreambuf_iterator<char>(in), {}};
    const json fields = schema()["properties"];
    for (const auto& [name, rule] : fields.items()) {
        if (name == "extensions" || name == "extras")
            continue;
        EXPECT_NE(page.find('`' + name + '`'), std::string::npos) << name;
    }
}

TEST(Swatches, EachFeelsDifferent) {
    const json gltf = test::GlbReader(swatches().bytes).json();
    std::vector<std::string> feels;
    for (const json& material : gltf["materials"])
        if (material.contains("extensions"))
            feels.push_back(material["extensions"].dump() +
                            (material.contains("normalTexture") ? "relief" : ""));
    ASSERT_EQ(feels.size(), 10u);
    std::sort(feels.begin(), feels.end());
    EXPECT_TRUE(std::adjacent_find(feels.begin(), feels.end()) == feels.end());
}

} // namespace
} // namespace touchstone::assets

#include "engine/import/materials/gltf_haptics.h"
#include "engine/scene/haptic_numbers.h"
#include "tests/unit/engine/load_support.h"

namespace touchstone::gltf_haptics_test {
namespace {

using nlohmann::json;
using test::GltfMaker;
using test::load;
using test::warns;

/// One grey pixel: R = G = B = 51/255 = 0.2.
constexpr const char* kGreyPixel =
    "data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR42mMwNjYGAAE2AJpHI3MJAAAAAElFTkSuQmCC";

GltfMaker withMaterial(const json& material) {
    GltfMaker maker = GltfMaker::square();
    maker.json["images"] = {{{"uri", kGreyPixel}}};
    maker.json["textures"] = {{{"source", 0}}};
    maker.json["materials"] = {material};
    maker.primitive()["material"] = 0;
    return maker;
}

GltfMaker withOurs(const json& ours) {
    json material = json::object();
    material["extensions"]["TOUCHSTONE_materials_haptic"] = ours;
    return withMaterial(material);
}

HapticMaterial hapticOf(const GltfMaker& maker) {
    const ScenePtr scene = load(maker);
    return scene->materials.at(static_cast<size_t>(scene->meshes.at(0).material)).haptic;
}

TEST(GltfHaptics, EveryNumberOfTheTableIsReadSettledAndBounded) {
    for (const HapticNumber& number : hapticNumbers()) {
        const std::string name(number.name);
        const ScenePtr scene = load(withOurs({{name, 0.5}}));
        const Material& material = scene->materials.at(0);
        EXPECT_EQ(material.says.ours.*number.stated, 0.5f) << name;
        if (number.settled != nullptr) {
            EXPECT_EQ((material.haptic.*number.settled).value, 0.5f) << name;
            EXPECT_EQ((material.haptic.*number.settled).source, HapticSource::Touchstone) << name;
        }
        EXPECT_REFUSED(withOurs({{name, number.least - 1.0}}),
                       "materials[0].extensions.TOUCHSTONE_materials_haptic." + name, "out of range");
        EXPECT_REFUSED(withOurs({{name, "much"}}),
                       "materials[0].extensions.TOUCHSTONE_materials_haptic." + name, "should be a number");
    }
    EXPECT_EQ(findHapticNumber("nosuch"), nullptr);
}

TEST(GltfHaptics, OurExtensionIsReadWhole) {
    const HapticMaterial haptic =
        hapticOf(withOurs({{"stiffness", 800},
                           {"damping", 1.5},
                           {"staticFriction", 0.6},
                           {"dynamicFriction", 0.4},
                           {"viscousFriction", 2},
                           {"normalTextureInfluence", 0.25},
                           {"heightTexture", {{"index", 0}, {"scale", 0.001}, {"midLevel", 0.25}}},
                           {"frictionTexture", {{"index", 0}, {"min", 0.5}, {"max", 2}}},
                           {"stiffnessTexture", {{"index", 0}}},
                           {"dampingTexture", {{"index", 0}, {"max", 3}}},
                           {"forceShading", "twoPass"},
                           {"sides", "front"}}));
    EXPECT_EQ(haptic.stiffness.value, 800.0f);
    EXPECT_EQ(haptic.stiffness.source, HapticSource::Touchstone);
    EXPECT_EQ(haptic.damping.value, 1.5f);
    EXPECT_EQ(haptic.staticFriction.value, 0.6f);
    EXPECT_EQ(haptic.dynamicFriction.value, 0.4f);
    EXPECT_EQ(haptic.viscousFriction.value, 2.0f);
    EXPECT_EQ(haptic.normalTextureInfluence.value, 0.25f);
    ASSERT_TRUE(haptic.height.value);
    EXPECT_EQ(haptic.height.value->scale, 0.001f);
    EXPECT_EQ(haptic.height.value->midLevel, 0.25f);
    EXPECT_EQ(haptic.height.value->texture.image, 0);
    EXPECT_EQ(haptic.friction.value->min, 0.5f);
    EXPECT_EQ(haptic.friction.value->max, 2.0f);
    EXPECT_EQ(haptic.stiffnessMap.value->min, 0.0f);
    EXPECT_EQ(haptic.dampingMap.value->max, 3.0f);
    EXPECT_EQ(haptic.forceShading, ShadingChoice::TwoPass);
    EXPECT_EQ(haptic.sides, SideChoice::Front);
}

TEST(GltfHaptics, AFileThatSaysNothingStatesNothing) {
    const HapticMaterial haptic = hapticOf(withMaterial(json::object()));
    EXPECT_FALSE(haptic.stiffness.value);
    EXPECT_FALSE(haptic.staticFriction.value);
    EXPECT_FALSE(haptic.dynamicFriction.value);
    EXPECT_EQ(haptic.staticFriction.source, HapticSource::Default);
    EXPECT_TRUE(haptic.unavailable.empty());
}

TEST(GltfHaptics, WrongTypesAndRangesNameTheField) {
    const std::string place = "materials[0].extensions.TOUCHSTONE_materials_haptic";
    EXPECT_REFUSED(withOurs(3), place, "object");
    EXPECT_REFUSED(withOurs({{"stiffness", "hard"}}), place + ".stiffness", "should be a number");
    EXPECT_REFUSED(withOurs({{"stiffness", 0}}), place + ".stiffness", "out of range");
    EXPECT_REFUSED(withOurs({{"damping", -1}}), place + ".damping", "out of range");
    EXPECT_REFUSED(withOurs({{"staticFriction", json::array()}}), place + ".staticFriction",
                   "should be a number");
    EXPECT_REFUSED(withOurs({{"dynamicFriction", nullptr}}), place + ".dynamicFriction",
                   "should be a number");
    EXPECT_REFUSED(withOurs({{"viscousFriction", 1e300}}), place + ".viscousFriction", "out of range");
    EXPECT_REFUSED(withOurs({{"normalTextureInfluence", 1.1}}), place + ".normalTextureInfluence",
                   "out of range");
    EXPECT_REFUSED(withOurs({{"heightTexture", {{"index", 0}}}}), place + ".heightTexture",
                   "'scale' is missing");
    EXPECT_REFUSED(withOurs({{"heightTexture", {{"scale", 1}}}}), place + ".heightTexture",
                   "'index' is missing");
    EXPECT_REFUSED(withOurs({{"heightTexture", {{"index", 4}, {"scale", 1}}}}),
                   place + ".heightTexture.index", "textures[4]");
    EXPECT_REFUSED(withOurs({{"heightTexture", {{"index", 0}, {"scale", 1}, {"midLevel", 2}}}}),
                   place + ".heightTexture.midLevel", "out of range");
    EXPECT_REFUSED(withOurs({{"frictionTexture", "a.png"}}), place + ".frictionTexture", "object");
    EXPECT_REFUSED(withOurs({{"frictionTexture", {{"index", 0}, {"min", -1}}}}),
                   place + ".frictionTexture.min", "out of range");
    EXPECT_REFUSED(withOurs({{"forceShading", "smooth"}}), place + ".forceShading", "not a choice");
    EXPECT_REFUSED(withOurs({{"forceShading", true}}), place + ".forceShading", "string");
    EXPECT_REFUSED(withOurs({{"sides", "back"}}), place + ".sides", "not a choice");
    EXPECT_REFUSED(withOurs({{"representation", "voxels"}}), place + ".representation", "not a choice");
    EXPECT_REFUSED(withOurs({{"shader", "a.glsl"}}), place + ".shader", "object");
    EXPECT_REFUSED(withOurs({{"shader", {{"source", "a.glsl"}, {"parameters", {1}}}}}),
                   place + ".shader.parameters", "object");
    EXPECT_REFUSED(withOurs({{"representation", "implicit"}, {"voxelSize", 0}}), place + ".voxelSize",
                   "out of range");
    EXPECT_REFUSED(withOurs({{"voxelSize", -1}}), place + ".voxelSize", "out of range");
    EXPECT_REFUSED(withOurs({{"fieldError", 0}}), place + ".fieldError", "out of range");
    EXPECT_REFUSED(withOurs({{"noiseAmplitude", -1e-9}}), place + ".noiseAmplitude", "out of range");
    EXPECT_REFUSED(withOurs({{"noiseWavelength", "long"}}), place + ".noiseWavelength", "should be a number");
    EXPECT_REFUSED(withOurs({{"noiseSeed", 1e9}}), place + ".noiseSeed", "out of range");
    EXPECT_REFUSED(withOurs({{"latticeAmplitude", 1e31}}), place + ".latticeAmplitude", "out of range");
    EXPECT_REFUSED(withOurs({{"latticeWavelength", 0}}), place + ".latticeWavelength", "out of range");
}

TEST(GltfHaptics, ReadsTheTextureOfADistanceField) {
    const ScenePtr scene = load(withOurs({{"representation", "implicit"},
                                          {"noiseAmplitude", 0.0002},
                                          {"noiseWavelength", 0.004},
                                          {"noiseSeed", 7},
                                          {"latticeAmplitude", 0.0006},
                                          {"latticeWavelength", 0.012}}));
    for (const char* name :
         {".noiseAmplitude", ".noiseWavelength", ".noiseSeed", ".latticeAmplitude", ".latticeWavelength"})
        EXPECT_FALSE(warns(*scene, name, "")) << name;
    EXPECT_EQ(scene->materials[0].haptic.fieldTexture, (FieldTexture{.noiseAmplitude = 0.0002f,
                                                                     .noiseWavelength = 0.004f,
                                                                     .noiseSeed = 7.0f,
                                                                     .latticeAmplitude = 0.0006f,
                                                                     .latticeWavelength = 0.012f}));
    EXPECT_TRUE(
        warns(*load(withOurs({{"noiseAmplitude", 0.0002}})), ".noiseAmplitude", "without representation"));
    EXPECT_TRUE(warns(*load(withOurs({{"representation", "implicit"}, {"latticeAmplitude", 0.0002}})),
                      ".latticeAmplitude", "without latticeWavelength"));
}

TEST(GltfHaptics, AFieldThatIsNotOursIsToldAndTheRestHolds) {
    const ScenePtr scene = load(withOurs({{"stifness", 800},
                                          {"staticFriction", 0.5},
                                          {"heightTexture", {{"index", 0}, {"scale", 0.001}, {"height", 2}}},
                                          {"frictionTexture", {{"index", 0}, {"scale", 2}}},
                                          {"shader", {{"source", "a.glsl"}, {"language", "c"}}},
                                          {"extras", {{"note", 1}}}}));
    const std::string place = "materials[0].extensions.TOUCHSTONE_materials_haptic";
    for (const char* field :
         {".stifness", ".heightTexture.height", ".frictionTexture.scale", ".shader.language"})
        EXPECT_TRUE(warns(*scene, place + field, "not a known field")) << field;
    EXPECT_FALSE(warns(*scene, place + ".extras", ""));
    EXPECT_EQ(scene->materials[0].haptic.staticFriction.value, 0.5f);
}

TEST(GltfHaptics, OurMapsHaveUvSetsTransformsAndWrapModesAsAnyTexture) {
    json info = {{"index", 0}, {"min", 0.1}, {"texCoord", 1}};
    info["extensions"]["KHR_texture_transform"] = {
        {"offset", {0.25, 0.5}}, {"scale", {2, 3}}, {"rotation", 1}};
    json height = info;
    height["scale"] = -0.002; // white may lie below black
    height.erase("min");
    GltfMaker maker = withOurs({{"heightTexture", height},
                                {"frictionTexture", info},
                                {"stiffnessTexture", info},
                                {"dampingTexture", info}});
    maker.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
    maker.json["textures"][0]["sampler"] = 0;
    const HapticMaterial haptic = hapticOf(maker);
    EXPECT_EQ(haptic.height.value->scale, -0.002f);
    EXPECT_EQ(haptic.height.value->midLevel, 0.5f);
    for (const TextureRef& texture : {haptic.height.value->texture, haptic.friction.value->texture,
                                      haptic.stiffnessMap.value->texture, haptic.dampingMap.value->texture}) {
        EXPECT_EQ(texture.texCoord, 1);
        EXPECT_EQ(texture.wrapS, Wrap::ClampToEdge);
        EXPECT_EQ(texture.wrapT, Wrap::MirroredRepeat);
        EXPECT_EQ(texture.offset, glm::vec2(0.25f, 0.5f));
        EXPECT_EQ(texture.scale, glm::vec2(2.0f, 3.0f));
        EXPECT_EQ(texture.rotation, 1.0f);
    }
    EXPECT_EQ(haptic.friction.value->min, 0.1f);
    EXPECT_EQ(haptic.friction.value->max, 1.0f);
}

TEST(GltfHaptics, AMapWhoseImageIsBrokenCostsTheMapAndNotTheModel) {
    GltfMaker maker = withOurs({{"stiffnessTexture", {{"index", 0}}}, {"stiffness", 700}});
    maker.json["images"][0]["uri"] = "data:image/png;base64,AAAA";
    const ScenePtr scene = load(maker);
    EXPECT_EQ(scene->materials[0].haptic.stiffness.value, 700.0f);
    EXPECT_FALSE(scene->images.at(0).problem.empty());
}

TEST(GltfHaptics, LaterWorkIsKeptAndReported) {
    const json shader = {{"source", "wood.glsl"}, {"parameters", {{"rings", 12}}}};
    const GltfMaker maker = withOurs({{"shader", shader},
                                      {"representation", "implicit"},
                                      {"voxelSize", 0.001},
                                      {"fieldError", 0.0001},
                                      {"forceShading", "bezier"}});
    const ScenePtr scene = load(maker);
    const HapticMaterial& haptic = scene->materials[0].haptic;
    const json& kept = haptic.unavailable.at("shader");
    EXPECT_EQ(kept, shader);
    EXPECT_TRUE(haptic.implicit);
    EXPECT_EQ(haptic.voxelSize, 0.001f);
    EXPECT_EQ(haptic.fieldError, 0.0001f);
    EXPECT_TRUE(warns(*load(withOurs({{"fieldError", 0.001}})), ".fieldError", "without representation"));
    EXPECT_EQ(haptic.forceShading, ShadingChoice::Bezier);
    EXPECT_FALSE(warns(*scene, ".representation", ""));
    EXPECT_FALSE(warns(*scene, ".forceShading", ""));
    EXPECT_TRUE(warns(*scene, ".shader", "wood.glsl")); // there is no such file
    EXPECT_TRUE(warns(*scene, ".shader", "the surface is plain"));
}

json mpegRoot() {
    const json map = {{"texture", {{"index", 0}}}, {"type", "High_Resolution"}};
    return {{"materials", {{{"stiffness", {map}}, {"friction", {map}}, {"vibrotactileTexture", {map}}}}}};
}

TEST(GltfHaptics, MpegMaterialsBindByMeshInBothSpellings) {
    for (const bool older : {false, true}) {
        GltfMaker maker = withMaterial({{"name", "m"}});
        if (older) {
            maker.json["extensions"]["MPEG_material_haptic"] = mpegRoot();
            maker.json["meshes"][0]["extensions"]["MPEG_material_haptic"] = 0;
        } else {
            maker.json["extensions"]["MPEG_haptic_material"] = mpegRoot();
            maker.json["meshes"][0]["extensions"]["MPEG_haptic_material"]["hapticMaterialIndex"] = 0;
        }
        const ScenePtr scene = load(maker);
        const Material& material = scene->materials.at(static_cast<size_t>(scene->meshes[0].material));
        EXPECT_EQ(material.name, "m"); // a copy of the mesh's own material
        ASSERT_TRUE(material.haptic.stiffnessMap.value);
        EXPECT_EQ(material.haptic.stiffnessMap.source, HapticSource::Mpeg);
        EXPECT_EQ(material.haptic.stiffnessMap.value->min, kMpegStiffnessMin);
        EXPECT_EQ(material.haptic.stiffnessMap.value->max, kMpegStiffnessMax);
        EXPECT_EQ(material.haptic.friction.value->max, kMpegFrictionMax);
        EXPECT_EQ(material.haptic.staticFriction.value, 1.0f);
        EXPECT_EQ(material.haptic.dynamicFriction.value, kSlidingShare);
        EXPECT_TRUE(warns(*scene, "vibrotactileTexture", "not yet available"));
        const json& kept = material.haptic.unavailable.at("MPEG_haptic_material");
        EXPECT_TRUE(kept.contains("vibrotactileTexture"));
        EXPECT_FALSE(scene->materials[0].haptic.stiffnessMap.value); // the plain material stays plain
    }
}

TEST(GltfHaptics, MpegMeshesMayNameTheirMaterialInEitherWay) {
    for (const char* spelling : {"MPEG_haptic_material", "MPEG_material_haptic"})
        for (const json& value : {json(0), json({{"hapticMaterialIndex", 0}})}) {
            GltfMaker maker = withMaterial(json::object());
            maker.json["extensions"][spelling] = mpegRoot();
            maker.json["meshes"][0]["extensions"][spelling] = value;
            EXPECT_TRUE(hapticOf(maker).stiffnessMap.value) << spelling << value;
            maker.json["extensions"] = json::object();
            EXPECT_MENDED(maker, "extensions", "neither the file nor \"extensions.gltf\"");
            EXPECT_FALSE(hapticOf(maker).stiffnessMap.value);
        }
}

TEST(GltfHaptics, MpegChannelsTakeTheFinestMapAndKeepTheRest) {
    GltfMaker maker = withMaterial(json::object());
    maker.json["images"].push_back({{"uri", kGreyPixel}});
    maker.json["textures"].push_back({{"source", 1}});
    const auto map = [](int texture, const char* type) {
        return json{{"texture", {{"index", texture}}}, {"type", type}};
    };
    json& material = maker.json["extensions"]["MPEG_haptic_material"]["materials"][0];
    material["name"] = "felt";
    material["stiffness"] = {map(0, "Low_Resolution"), map(1, "High_Resolution"), map(0, "High_Resolution")};
    material["friction"] = {map(0, "Reference")}; // an index of signals, no coefficient
    material["temperature"] = {map(0, "Other")};
    material["later"] = {map(0, "Other")};
    maker.json["meshes"][0]["extensions"]["MPEG_haptic_material"]["hapticMaterialIndex"] = 0;
    const ScenePtr scene = load(maker);
    const HapticMaterial& haptic =
        scene->materials.at(static_cast<size_t>(scene->meshes.at(0).material)).haptic;
    EXPECT_EQ(haptic.stiffnessMap.value->texture.image, 1);
    EXPECT_FALSE(haptic.friction.value);
    EXPECT_TRUE(warns(*scene, "friction[0]", "signals"));
    const json& kept = haptic.unavailable.at("MPEG_haptic_material");
    for (const char* channel : {"temperature", "later"}) {
        EXPECT_EQ(kept[channel], material[channel]);
        EXPECT_TRUE(warns(*scene, channel, "not yet available"));
    }
    EXPECT_FALSE(warns(*scene, "name", ""));
}

TEST(GltfHaptics, BrokenMpegMaterialsCostThemselvesAndNameTheField) {
    GltfMaker maker = withMaterial(json::object());
    json& root = maker.json["extensions"]["MPEG_haptic_material"];
    json& reference = maker.json["meshes"][0]["extensions"]["MPEG_haptic_material"];
    root = mpegRoot();
    for (const json& wrong : {json(1), json(-1), json(0.5), json("0")}) {
        reference["hapticMaterialIndex"] = wrong;
        EXPECT_MENDED(maker, "meshes[0].extensions.MPEG_haptic_material.hapticMaterialIndex",
                      "felt without it");
    }
    reference = json::object();
    EXPECT_MENDED(maker, "meshes[0].extensions.MPEG_haptic_material", "no hapticMaterialIndex");
    reference["hapticMaterialIndex"] = 0.0; // an integer all the same
    EXPECT_TRUE(hapticOf(maker).stiffnessMap.value);
    json& stiffness = root["materials"][0]["stiffness"];
    stiffness = {{{"type", "Other"}}};
    EXPECT_MENDED(maker, "extensions.MPEG_haptic_material.materials[0].stiffness[0]", "index");
    stiffness = {{{"texture", {{"index", 7}}}}, {{"texture", {{"index", 0}}}}};
    EXPECT_MENDED(maker, "extensions.MPEG_haptic_material.materials[0].stiffness[0]", "textures[7]");
    EXPECT_TRUE(hapticOf(maker).stiffnessMap.value) << "the next map";
    root["materials"] = {7};
    EXPECT_MENDED(maker, "extensions.MPEG_haptic_material.materials[0]", "object");
    root["materials"] = "none";
    EXPECT_MENDED(maker, "extensions.MPEG_haptic_material.materials", "array");
    root = 5;
    EXPECT_MENDED(maker, "extensions.MPEG_haptic_material", "holds no materials");
}

TEST(GltfHaptics, MpegMaterialsAreReadInEveryShapeOfTheDrafts) {
    const json map = {{"texture", {{"index", 0}}}, {"type", "High_Resolution"}};
    const json material = {{"name", "cloth"}, {"stiffness", {map}}};
    std::vector<json> roots = {
        {{"materials", {material}}}, {{"materials", material}}, json::array({material}), material};
    for (const json& written :
         {json(map), json::array({{{"texture", {{"index", 0}}}}}), json::array({{{"texture", 0}}}),
          json::array({{{"index", 0}}}), json(0), json::array({0})})
        roots.push_back(json::array({{{"stiffness", written}}}));
    for (const char* spelling : {"MPEG_haptic_material", "MPEG_material_haptic"})
        for (const json& root : roots) {
            GltfMaker maker = withMaterial(json::object());
            maker.json["extensionsUsed"] = {spelling};
            maker.json["extensions"][spelling] = root;
            maker.json["meshes"][0]["extensions"][spelling] = 0;
            EXPECT_TRUE(hapticOf(maker).stiffnessMap.value) << root;
            EXPECT_TRUE(load(maker)->warnings.empty()) << test::warningsOf(*load(maker));
        }
}

/// As the extension's public sample has it: the mesh says 0, the materials are a bare array in a file beside
/// it, which holds comments, and nothing is declared.
TEST(GltfHaptics, MpegMaterialsMayBeInAFileBesideTheModel) {
    const test::TemporaryFolder folder;
    GltfMaker maker = withMaterial(json::object());
    maker.json["meshes"][0]["extensions"]["MPEG_material_haptic"] = 0;
    test::writeFile(folder.path() / "main.glb", maker.glb());
    const auto loaded = [&] { return loadScene(folder.path() / "main.glb"); };
    const auto stiffness = [](const Scene& scene) {
        return scene.materials.at(static_cast<size_t>(scene.meshes.at(0).material)).haptic.stiffnessMap.value;
    };
    EXPECT_TRUE(warns(*loaded(), "extensions", "neither the file nor"));
    const auto beside = [&](const std::string& text) {
        test::writeFile(folder.path() / "extensions.gltf", text);
    };
    beside(R"({"extensions": {"MPEG_material_haptic": [ {"name": "cover",
        // the texture is the model's
        "stiffness": [{"texture": {"index": 0}, "type": "Low_Resolution"}],
        "vibration": [{"texture": {"index": 0}, "type": "Low_Resolution"}]}]}})");
    const ScenePtr scene = loaded();
    EXPECT_TRUE(stiffness(*scene));
    EXPECT_TRUE(
        warns(*scene, "extensions.gltf: extensions.MPEG_material_haptic[0].vibration", "not yet available"))
        << test::warningsOf(*scene);
    for (const char* broken : {"", "nonsense", "{}", "[]", "{\"extensions\": 3}",
                               "{\"extensions\": {\"MPEG_material_haptic\": 3}}"}) {
        beside(broken);
        const ScenePtr without = loaded();
        EXPECT_EQ(without->triangleCount(), 2u) << broken;
        EXPECT_FALSE(stiffness(*without)) << broken;
        EXPECT_TRUE(warns(*without, "extensions.gltf", "felt without"))
            << broken << test::warningsOf(*without);
    }
    // Its own materials come first.
    beside("nonsense");
    maker.json["extensions"]["MPEG_material_haptic"] = mpegRoot();
    test::writeFile(folder.path() / "main.glb", maker.glb());
    EXPECT_TRUE(stiffness(*loaded()));
}

/// Two nodes with the same mesh; the first has a collider with physics material 0.
GltfMaker withPhysics() {
    GltfMaker maker = withMaterial({{"pbrMetallicRoughness", {{"roughnessFactor", 0.5}}}});
    maker.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}}};
    maker.json["scenes"] = {{{"nodes", {0, 1}}}};
    maker.json["extensions"]["KHR_physics_rigid_bodies"]["physicsMaterials"] = {{{"staticFriction", 0.9}}};
    maker.json["nodes"][0]["extensions"]["KHR_physics_rigid_bodies"]["collider"]["physicsMaterial"] = 0;
    return maker;
}

/// One material that 1000 colliders make 1000 of would hold what nobody reads of the file 1000 times.
TEST(GltfHaptics, MaterialsThatPhysicsMaterialsMakeOfOneShareTheJsonThatIsKept) {
    GltfMaker maker = withPhysics();
    maker.json["materials"][0]["extensions"]["TOUCHSTONE_materials_haptic"] = {
        {"shader", {{"source", std::string(1000, 'x')}}}};
    maker.json["extensions"]["MPEG_haptic_material"] = mpegRoot();
    maker.json["meshes"][0]["extensions"]["MPEG_haptic_material"]["hapticMaterialIndex"] = 0;
    const ScenePtr scene = load(maker);
    ASSERT_EQ(scene->meshes.size(), 2u);
    const auto materialOf = [&](size_t mesh) -> const Material& {
        return scene->materials[static_cast<size_t>(scene->meshes[mesh].material)];
    };
    const Material &one = materialOf(0), &other = materialOf(1);
    ASSERT_NE(one.says.physicsStatic, other.says.physicsStatic);
    const json &shader = one.says.ours.shader, &otherShader = other.says.ours.shader;
    const json &mpeg = one.says.mpegUnavailable, &otherMpeg = other.says.mpegUnavailable;
    EXPECT_EQ(shader.at("source").get<std::string>().size(), 1000u);
    EXPECT_TRUE(mpeg.contains("vibrotactileTexture"));
    EXPECT_EQ(&shader, &otherShader);
    EXPECT_EQ(&mpeg, &otherMpeg);
    for (const Material* material : {&one, &other}) {
        const json &told = material->haptic.unavailable.at("shader"),
                   &toldMpeg = material->haptic.unavailable.at("MPEG_haptic_material");
        EXPECT_EQ(&told, &shader);
        EXPECT_EQ(&toldMpeg, &mpeg);
    }
}

TEST(GltfHaptics, PhysicsMaterialsBindByCollider) {
    const ScenePtr scene = load(withPhysics());
    ASSERT_EQ(scene->instances.size(), 2u);
    const auto materialOf = [&](size_t instance) -> const HapticMaterial& {
        return scene
            ->materials[static_cast<size_t>(
                scene->meshes[static_cast<size_t>(scene->instances[instance].mesh)].material)]
            .haptic;
    };
    EXPECT_EQ(materialOf(0).staticFriction.value, 0.9f);
    EXPECT_EQ(materialOf(0).dynamicFriction.value, kPhysicsFriction); // the extension's default
    EXPECT_EQ(materialOf(0).staticFriction.source, HapticSource::Physics);
    EXPECT_EQ(materialOf(1).staticFriction.source,
              HapticSource::DerivedFromPbr); // the other node keeps its own
}

TEST(GltfHaptics, ACollidersNodeWithoutAMeshSpeaksForItsAncestorOrGeometry) {
    GltfMaker maker = withPhysics();
    maker.json["nodes"] = {{{"mesh", 0}, {"children", {1}}}, {{"children", {2}}}, json::object()};
    maker.json["scenes"] = {{{"nodes", {0}}}};
    json& collider = maker.json["nodes"][2]["extensions"]["KHR_physics_rigid_bodies"]["collider"];
    collider["physicsMaterial"] = 0;
    EXPECT_EQ(hapticOf(maker).staticFriction.value, 0.9f);
    collider["physicsMaterial"] = 1;
    EXPECT_MENDED(maker, "nodes[2].extensions.KHR_physics_rigid_bodies.collider.physicsMaterial",
                  "physicsMaterials[1]");
}

TEST(GltfHaptics, PrecedenceIsPerField) {
    GltfMaker maker = withPhysics();
    maker.json["materials"][0]["extensions"]["TOUCHSTONE_materials_haptic"] = {{"dynamicFriction", 0.3},
                                                                               {"stiffness", 700}};
    maker.json["extensions"]["MPEG_haptic_material"] = mpegRoot();
    maker.json["meshes"][0]["extensions"]["MPEG_haptic_material"]["hapticMaterialIndex"] = 0;
    const HapticMaterial haptic = hapticOf(maker);
    EXPECT_EQ(haptic.dynamicFriction.value, 0.3f);
    EXPECT_EQ(haptic.dynamicFriction.source, HapticSource::Touchstone);
    EXPECT_EQ(haptic.staticFriction.value,
              0.9f); // ours gives none; MPEG's map would be of another kind beside ours
    EXPECT_EQ(haptic.staticFriction.source, HapticSource::Physics);
    EXPECT_EQ(haptic.stiffness.source, HapticSource::Touchstone);
    EXPECT_EQ(haptic.stiffnessMap.source, HapticSource::Mpeg);
    EXPECT_FALSE(haptic.friction.value);
    // The rest of the ablation, field by field: ours, MPEG's, physics, the roughness that the file states.
    maker.json["materials"][0]["extensions"]["TOUCHSTONE_materials_haptic"] = {
        {"stiffnessTexture", {{"index", 0}, {"min", 0.7}}}};
    const HapticMaterial mixed = hapticOf(maker);
    EXPECT_EQ(mixed.stiffnessMap.source, HapticSource::Touchstone);
    EXPECT_EQ(mixed.stiffnessMap.value->min, 0.7f);
    EXPECT_EQ(mixed.friction.source, HapticSource::Mpeg);
    EXPECT_EQ(mixed.staticFriction.source, HapticSource::Mpeg);
    maker.json["meshes"][0].erase("extensions");
    EXPECT_EQ(hapticOf(maker).staticFriction.source, HapticSource::Physics);
    maker.json["nodes"][0].erase("extensions");
    EXPECT_EQ(hapticOf(maker).staticFriction.source, HapticSource::DerivedFromPbr);
}

TEST(GltfHaptics, FrictionIsDerivedOnlyFromStatedRoughness) {
    const auto of = [](const json& pbr) { return hapticOf(withMaterial({{"pbrMetallicRoughness", pbr}})); };
    EXPECT_FALSE(of(json::object()).staticFriction.value);
    EXPECT_FALSE(of({{"metallicFactor", 0.0}}).staticFriction.value);
    const HapticMaterial half = of({{"roughnessFactor", 0.5}});
    EXPECT_NEAR(*half.staticFriction.value, 0.15 + 0.6 * 0.5, 1e-6);
    EXPECT_NEAR(*half.dynamicFriction.value, 0.8 * 0.45, 1e-6);
    EXPECT_EQ(half.staticFriction.source, HapticSource::DerivedFromPbr);
    // The texture states it too: its green is 0.2 everywhere.
    EXPECT_NEAR(*of({{"metallicRoughnessTexture", {{"index", 0}}}}).staticFriction.value, 0.15 + 0.6 * 0.2,
                1e-6);
    EXPECT_NEAR(
        *of({{"roughnessFactor", 0.5}, {"metallicRoughnessTexture", {{"index", 0}}}}).staticFriction.value,
        0.15 + 0.6 * 0.1, 1e-6);
}

TEST(GltfHaptics, ADerivedCoefficientNeverTurnsAStatedPairRound) {
    HapticMaterial slippery;
    slippery.staticFriction = {0.1f, HapticSource::Touchstone};
    deriveFriction(slippery, 1.0f);
    EXPECT_EQ(slippery.dynamicFriction.value, 0.1f);
    HapticMaterial sticky;
    sticky.dynamicFriction = {2.0f, HapticSource::Touchstone};
    deriveFriction(sticky, 0.0f);
    EXPECT_EQ(sticky.staticFriction.value, 2.0f);
}

} // namespace
} // namespace touchstone::gltf_haptics_test

#include "tests/unit/engine/load_support.h"

#include <cmath>

namespace touchstone::gltf_materials_test {
namespace {

using nlohmann::json;
using test::GltfMaker;
using test::load;
using test::warns;

constexpr const char* kBlackPixel =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR42mNgAAAAAgAB5Sfe/"
    "AAAAABJRU5ErkJggg==";

/// The square with one material, and two textures over one missing image.
GltfMaker withMaterial(const json& material) {
    GltfMaker maker = GltfMaker::square();
    maker.json["images"] = {{{"uri", "nowhere.png"}}};
    maker.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
    maker.json["textures"] = {{{"source", 0}}, {{"source", 0}, {"sampler", 0}}};
    maker.json["materials"] = {material};
    maker.primitive()["material"] = 0;
    return maker;
}

/// Keeps the texture references although their image is missing: nothing is decoded, nothing is dropped.
Material read(const json& material) {
    GltfMaker maker = withMaterial(material);
    maker.json["images"] = {{{"uri", kBlackPixel}}};
    const ScenePtr scene = load(maker);
    EXPECT_TRUE(scene->images.at(0).problem.empty()) << scene->images[0].problem;
    return scene->materials.at(0);
}

TEST(GltfMaterials, DefaultsAreThoseOfTheSpecification) {
    const Material material = read(json::object());
    EXPECT_EQ(material.baseColor, glm::vec4(1.0f));
    EXPECT_EQ(material.metallic, 1.0f);
    EXPECT_EQ(material.roughness, 1.0f);
    EXPECT_FALSE(material.roughnessStated);
    EXPECT_FALSE(material.metallicStated);
    EXPECT_EQ(material.alphaMode, AlphaMode::Opaque);
    EXPECT_EQ(material.alphaCutoff, 0.5f);
    EXPECT_FALSE(material.doubleSided);
}

TEST(GltfMaterials, StatedValuesAreRead) {
    const Material material = read({{"name", "gold"},
                                    {"pbrMetallicRoughness",
                                     {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
                                      {"metallicFactor", 0.5},
                                      {"roughnessFactor", 1.0},
                                      {"baseColorTexture", {{"index", 1}, {"texCoord", 1}}}}},
                                    {"normalTexture", {{"index", 0}, {"scale", 0.7}}},
                                    {"occlusionTexture", {{"index", 0}, {"strength", 0.25}}},
                                    {"emissiveFactor", {1, 0.5, 0}},
                                    {"alphaMode", "MASK"},
                                    {"alphaCutoff", 0.3},
                                    {"doubleSided", true}});
    EXPECT_EQ(material.name, "gold");
    EXPECT_EQ(material.baseColor, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
    EXPECT_EQ(material.metallic, 0.5f);
    EXPECT_TRUE(material.roughnessStated); // stated, though it is the default
    EXPECT_EQ(material.baseColorTexture.texCoord, 1);
    EXPECT_EQ(material.baseColorTexture.wrapS, Wrap::ClampToEdge);
    EXPECT_EQ(material.baseColorTexture.wrapT, Wrap::MirroredRepeat);
    EXPECT_TRUE(material.baseColorTexture.nearest);
    EXPECT_EQ(material.normalTexture.wrapS, Wrap::Repeat);
    EXPECT_EQ(material.normalScale, 0.7f);
    EXPECT_EQ(material.occlusionStrength, 0.25f);
    EXPECT_EQ(material.emissive, glm::vec3(1, 0.5f, 0));
    EXPECT_EQ(material.alphaMode, AlphaMode::Mask);
    EXPECT_EQ(material.alphaCutoff, 0.3f);
    EXPECT_TRUE(material.doubleSided);
}

TEST(GltfMaterials, TextureTransformsAreReadAndMoveUvs) {
    json info = {{"index", 0}, {"texCoord", 0}};
    info["extensions"]["KHR_texture_transform"] = {
        {"offset", {0.25, 0.5}}, {"rotation", std::acos(0.0)}, {"scale", {2, 3}}, {"texCoord", 1}};
    json material = json::object();
    material["pbrMetallicRoughness"]["baseColorTexture"] = info;
    const TextureRef texture = read(material).baseColorTexture;
    EXPECT_EQ(texture.texCoord, 1);
    EXPECT_EQ(texture.offset, glm::vec2(0.25f, 0.5f));
    EXPECT_EQ(texture.scale, glm::vec2(2, 3));
    // A quarter turn, counter-clockwise as seen with v pointing down: u goes to -v, v to u.
    const glm::vec2 moved = texture.transform({1.0f, 0.0f});
    EXPECT_NEAR(moved.x, 0.25, 1e-6);
    EXPECT_NEAR(moved.y, 0.5 - 2.0, 1e-6);

    info["extensions"]["KHR_texture_transform"] = {{"offset", {0.25}}};
    material["pbrMetallicRoughness"]["baseColorTexture"] = info;
    EXPECT_MENDED(
        withMaterial(material),
        "materials[0].pbrMetallicRoughness.baseColorTexture.extensions.KHR_texture_transform.offset",
        "two numbers");
    info["extensions"]["KHR_texture_transform"] = {{"offset", {1e39, 0.0}}};
    material["pbrMetallicRoughness"]["baseColorTexture"] = info;
    EXPECT_MENDED(
        withMaterial(material),
        "materials[0].pbrMetallicRoughness.baseColorTexture.extensions.KHR_texture_transform.offset",
        "32-bit");
}

TEST(GltfMaterials, FactorsOutsideTheirRangeAreClamped) {
    const ScenePtr scene = load(withMaterial({{"pbrMetallicRoughness", {{"roughnessFactor", 1.5}}}}));
    EXPECT_EQ(scene->materials[0].roughness, 1.0f);
    EXPECT_TRUE(warns(*scene, "materials[0].pbrMetallicRoughness.roughnessFactor", "clamped"));
    EXPECT_MENDED(withMaterial({{"pbrMetallicRoughness", {{"roughnessFactor", "rough"}}}}),
                  "materials[0].pbrMetallicRoughness.roughnessFactor", "number");
}

TEST(GltfMaterials, UnresolvedTexturesAreLeftOut) {
    EXPECT_MENDED(withMaterial({{"normalTexture", {{"index", 9}}}}), "materials[0].normalTexture.index",
                  "textures[9]");
    EXPECT_MENDED(withMaterial({{"normalTexture", {{"texCoord", 0}}}}), "materials[0].normalTexture",
                  "'index' is missing");
    EXPECT_MENDED(withMaterial({{"normalTexture", 0}}), "materials[0].normalTexture", "object");
}

TEST(GltfMaterials, TheDefaultMaterialIsAppendedOnlyIfNeeded) {
    GltfMaker maker = withMaterial({{"name", "only"}});
    EXPECT_EQ(load(maker)->materials.size(), 1u);
    maker.json["meshes"][0]["primitives"].push_back(maker.primitive());
    maker.json["meshes"][0]["primitives"][1].erase("material");
    const ScenePtr scene = load(maker);
    ASSERT_EQ(scene->materials.size(), 2u);
    EXPECT_EQ(scene->meshes[0].material, 0);
    EXPECT_EQ(scene->meshes[1].material, 1);
}

} // namespace
} // namespace touchstone::gltf_materials_test

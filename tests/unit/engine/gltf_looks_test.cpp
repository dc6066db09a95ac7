// KHR_materials_*: every field that is drawn, its default, and what becomes of a wrong one.

#include "tests/support/encoded_image.h"
#include "tests/unit/engine/load_support.h"

namespace touchstone::gltf_looks_test {
namespace {

using nlohmann::json;
using test::GltfMaker;
using test::load;
using test::warns;

GltfMaker withExtensions(const json& extensions, json material = json::object()) {
    GltfMaker maker = GltfMaker::square();
    const std::vector<uint8_t> png =
        test::encodedImage("a.png", 2, 2, 3, std::vector<uint8_t>(12, uint8_t{128}));
    for (int i = 0; i < 4; ++i) {
        maker.append("images",
                     {{"bufferView", maker.addView(png.data(), png.size())}, {"mimeType", "image/png"}});
        maker.append("textures", {{"source", i}});
    }
    material["extensions"] = extensions;
    maker.json["materials"] = {material};
    for (const auto& [name, extension] : extensions.items())
        maker.json["extensionsUsed"].push_back(name);
    maker.primitive()["material"] = 0;
    return maker;
}

json map(int index) {
    return {{"index", index}};
}

/// The material of a file that must load without a warning.
Material read(const json& extensions, const json& material = json::object()) {
    const ScenePtr scene = load(withExtensions(extensions, material));
    EXPECT_TRUE(scene->warnings.empty()) << scene->warnings.front().place << scene->warnings.front().message;
    return scene->materials.at(0);
}

TEST(GltfLooks, WithoutExtensionsNothingIsChanged) {
    const Material material = read(json::object());
    EXPECT_FALSE(material.unlit);
    EXPECT_FALSE(material.specularGlossiness.used);
    EXPECT_EQ(material.specular.ior, 1.5f);
    EXPECT_EQ(material.specular.factor, 1.0f);
    EXPECT_EQ(material.clearcoat.factor, 0.0f);
    EXPECT_EQ(material.sheen.color, glm::vec3(0.0f));
    EXPECT_EQ(material.transmission.factor, 0.0f);
    EXPECT_EQ(material.transmission.thickness, 0.0f);
}

TEST(GltfLooks, UnlitIsRead) {
    EXPECT_TRUE(read({{"KHR_materials_unlit", json::object()}}).unlit);
    const ScenePtr both = load(withExtensions(
        {{"KHR_materials_unlit", json::object()}, {"KHR_materials_clearcoat", json::object()}}));
    EXPECT_TRUE(
        warns(*both, "materials[0].extensions.KHR_materials_unlit", "KHR_materials_clearcoat is not"));
}

TEST(GltfLooks, SpecularGlossinessStandsInPlaceOfMetallicRoughness) {
    const json core = {
        {"pbrMetallicRoughness", {{"baseColorFactor", {0.9, 0.9, 0.9, 1.0}}, {"baseColorTexture", map(3)}}}};
    const Material material = read({{"KHR_materials_pbrSpecularGlossiness",
                                     {{"diffuseFactor", {0.1, 0.2, 0.3, 0.4}},
                                      {"diffuseTexture", map(1)},
                                      {"specularFactor", {0.5, 0.6, 0.7}},
                                      {"glossinessFactor", 0.8},
                                      {"specularGlossinessTexture", map(2)}}}},
                                   core);
    EXPECT_TRUE(material.specularGlossiness.used);
    EXPECT_EQ(material.baseColor, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
    EXPECT_EQ(material.baseColorTexture.image, 1);
    EXPECT_EQ(material.specularGlossiness.specular, glm::vec3(0.5f, 0.6f, 0.7f));
    EXPECT_EQ(material.specularGlossiness.glossiness, 0.8f);
    EXPECT_EQ(material.specularGlossiness.texture.image, 2);

    const Material plain = read({{"KHR_materials_pbrSpecularGlossiness", json::object()}}, core);
    EXPECT_EQ(plain.baseColor, glm::vec4(1.0f)) << "the core colour is a fallback of other programs";
    EXPECT_FALSE(plain.baseColorTexture);
    EXPECT_EQ(plain.specularGlossiness.specular, glm::vec3(1.0f));
    EXPECT_EQ(plain.specularGlossiness.glossiness, 1.0f);
}

TEST(GltfLooks, LayersAreRead) {
    const Material material = read({{"KHR_materials_emissive_strength", {{"emissiveStrength", 4.0}}},
                                    {"KHR_materials_ior", {{"ior", 1.33}}},
                                    {"KHR_materials_specular",
                                     {{"specularFactor", 0.5},
                                      {"specularTexture", map(0)},
                                      {"specularColorFactor", {2.0, 0.5, 0.25}},
                                      {"specularColorTexture", map(1)}}},
                                    {"KHR_materials_clearcoat",
                                     {{"clearcoatFactor", 0.75},
                                      {"clearcoatTexture", map(2)},
                                      {"clearcoatRoughnessFactor", 0.25},
                                      {"clearcoatRoughnessTexture", map(3)}}},
                                    {"KHR_materials_sheen",
                                     {{"sheenColorFactor", {0.1, 0.2, 0.3}},
                                      {"sheenColorTexture", map(0)},
                                      {"sheenRoughnessFactor", 0.4},
                                      {"sheenRoughnessTexture", map(1)}}}},
                                   {{"emissiveFactor", {0.5, 0.25, 0.0}}});
    EXPECT_EQ(material.emissive, glm::vec3(2.0f, 1.0f, 0.0f));
    EXPECT_EQ(material.specular.ior, 1.33f);
    EXPECT_EQ(material.specular.factor, 0.5f);
    EXPECT_EQ(material.specular.texture.image, 0);
    EXPECT_EQ(material.specular.color, glm::vec3(2.0f, 0.5f, 0.25f)) << "may exceed 1";
    EXPECT_EQ(material.specular.colorTexture.image, 1);
    EXPECT_EQ(material.clearcoat.factor, 0.75f);
    EXPECT_EQ(material.clearcoat.texture.image, 2);
    EXPECT_EQ(material.clearcoat.roughness, 0.25f);
    EXPECT_EQ(material.clearcoat.roughnessTexture.image, 3);
    EXPECT_EQ(material.sheen.color, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(material.sheen.colorTexture.image, 0);
    EXPECT_EQ(material.sheen.roughness, 0.4f);
    EXPECT_EQ(material.sheen.roughnessTexture.image, 1);
}

TEST(GltfLooks, TransmissionAndVolumeAreRead) {
    const Material glass =
        read({{"KHR_materials_transmission", {{"transmissionFactor", 0.9}, {"transmissionTexture", map(0)}}},
              {"KHR_materials_volume",
               {{"thicknessFactor", 0.02},
                {"thicknessTexture", map(1)},
                {"attenuationColor", {0.9, 0.2, 0.1}},
                {"attenuationDistance", 0.05}}}});
    EXPECT_EQ(glass.alphaMode, AlphaMode::Opaque) << "its alpha is what it was";
    EXPECT_EQ(glass.baseColor.w, 1.0f);
    EXPECT_EQ(glass.transmission.factor, 0.9f);
    EXPECT_EQ(glass.transmission.texture.image, 0);
    EXPECT_EQ(glass.transmission.thickness, 0.02f);
    EXPECT_EQ(glass.transmission.thicknessTexture.image, 1);
    EXPECT_EQ(glass.transmission.attenuationColor, glm::vec3(0.9f, 0.2f, 0.1f));
    EXPECT_EQ(glass.transmission.attenuationDistance, 0.05f);
}

TEST(GltfLooks, WhatIsWrongIsDrawnWithItsDefaultAndWarnedOf) {
    const ScenePtr scene = load(withExtensions(
        {{"KHR_materials_clearcoat",
          {{"clearcoatFactor", "nonsense"},
           {"clearcoatTexture", map(99)},
           {"clearcoatNormalTexture", map(0)}}},
         {"KHR_materials_sheen", {{"sheenColorFactor", {0.5, 0.5}}, {"sheenRoughnessFactor", 7}}},
         {"KHR_materials_transmission", 3}}));
    EXPECT_EQ(scene->triangleCount(), 2u);
    const Material& material = scene->materials[0];
    EXPECT_EQ(material.clearcoat.factor, 0.0f);
    EXPECT_FALSE(material.clearcoat.texture);
    EXPECT_EQ(material.sheen.color, glm::vec3(0.0f));
    EXPECT_EQ(material.sheen.roughness, 1.0f);
    const std::string at = "materials[0].extensions.";
    EXPECT_TRUE(warns(*scene, at + "KHR_materials_clearcoat.clearcoatFactor", "should be a number"));
    EXPECT_TRUE(warns(*scene, at + "KHR_materials_clearcoat.clearcoatTexture", "textures[99]"));
    EXPECT_TRUE(warns(*scene, at + "KHR_materials_clearcoat.clearcoatNormalTexture", "not supported"));
    EXPECT_TRUE(warns(*scene, at + "KHR_materials_sheen.sheenColorFactor", "3 numbers"));
    EXPECT_TRUE(warns(*scene, at + "KHR_materials_sheen.sheenRoughnessFactor", "clamped"));
    EXPECT_TRUE(warns(*scene, at + "KHR_materials_transmission", "should be an object"));
    EXPECT_EQ(scene->warnings.size(), 6u);
}

TEST(GltfLooks, ImagesOfTheExtensionsAreDecodedForTheEye) {
    LoadOptions options;
    options.images = {.visual = true, .haptic = false};
    const ScenePtr scene =
        load(withExtensions({{"KHR_materials_sheen", {{"sheenColorTexture", map(2)}}}}), options);
    EXPECT_TRUE(scene->images[2].decoded);
    EXPECT_FALSE(scene->images[1].decoded);
}

} // namespace
} // namespace touchstone::gltf_looks_test
